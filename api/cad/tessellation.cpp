#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IMeshTools_Parameters.hxx>
#include <NCollection_DataMap.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Lin.hxx>
#include <gp_Pln.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>
#include <numbers>
#include <numeric>

#include "api/cad/answer.hpp"
#include "api/cad/parts.hpp"

namespace symcell::cad {
namespace {

enum class Kind : std::uint32_t { kPlane, kCylinder, kCone, kSphere, kTorus, kOther };

struct Surface {
  Kind kind = Kind::kOther;
  gp_Pnt origin;
  gp_Dir direction;
  gp_Pnt apex;
  double radius = 0, tube_radius = 0, half_angle = 0;
};

// Circles get a multiple of so many chords, so that those about an axis of 2, 3, 4, 6 or 12 copies have
// them in phase.
constexpr int kChordsOfCircle = 12;
// Surfaces of two faces are one if they are this near, of the diameter; directions to so many radians.
constexpr double kSameRel = 1e-7;
constexpr double kSameDirection = 1e-7;
// No chord is divided once it is so short, of the diameter: it is a point to every file's tolerance.
constexpr double kLeastChordRel = 1e-6;
// Millimetres: no part is as large.
constexpr double kLargest = 1e12;

Surface surface_of(const Adaptor3d_Surface& adaptor) {
  Surface s;
  switch (adaptor.GetType()) {
    case GeomAbs_Plane: {
      const gp_Pln plane = adaptor.Plane();
      s.kind = Kind::kPlane;
      s.origin = plane.Location();
      s.direction = plane.Axis().Direction();
      break;
    }
    case GeomAbs_Cylinder: {
      const gp_Cylinder cylinder = adaptor.Cylinder();
      s.kind = Kind::kCylinder;
      s.origin = cylinder.Location();
      s.direction = cylinder.Axis().Direction();
      s.radius = cylinder.Radius();
      break;
    }
    case GeomAbs_Cone: {
      const gp_Cone cone = adaptor.Cone();
      s.kind = Kind::kCone;
      s.origin = s.apex = cone.Apex();
      // From the apex to where it is wide.
      s.direction = cone.Axis().Direction();
      if (cone.SemiAngle() < 0) s.direction.Reverse();
      s.half_angle = std::abs(cone.SemiAngle());
      break;
    }
    case GeomAbs_Sphere: {
      const gp_Sphere sphere = adaptor.Sphere();
      s.kind = Kind::kSphere;
      s.origin = sphere.Location();
      s.radius = sphere.Radius();
      break;
    }
    case GeomAbs_Torus: {
      const gp_Torus torus = adaptor.Torus();
      s.kind = Kind::kTorus;
      s.origin = torus.Location();
      s.direction = torus.Axis().Direction();
      s.radius = torus.MajorRadius();
      s.tube_radius = torus.MinorRadius();
      break;
    }
    default: break;
  }
  return s;
}

// What IGES has in the place of cylinders and cones: a line that is turned about an axis.
Surface surface_of_turned_line(const gp_Ax1& axis, const gp_Lin& line) {
  Surface s;
  s.direction = axis.Direction();
  const gp_Pnt p = line.Location();
  const auto foot = [&](const gp_Pnt& q) {
    const double along = gp_Vec(axis.Location(), q).Dot(gp_Vec(axis.Direction()));
    return axis.Location().Translated(along * gp_Vec(axis.Direction()));
  };
  if (line.Direction().IsParallel(axis.Direction(), kSameDirection)) {
    s.kind = Kind::kCylinder;
    s.origin = foot(p);
    s.radius = p.Distance(s.origin);
    return s;
  }
  if (line.Direction().IsNormal(axis.Direction(), kSameDirection)) {
    s.kind = Kind::kPlane;
    s.origin = p;
    return s;
  }
  // A cone, if the line meets the axis.
  const gp_Vec across = gp_Vec(line.Direction()).Crossed(gp_Vec(axis.Direction()));
  const gp_Vec apart(axis.Location(), p);
  const double scale = std::max(apart.Magnitude(), p.Distance(foot(p)));
  if (std::abs(apart.Dot(across)) > kSameRel * scale * across.Magnitude()) return s;
  const double t = -apart.Crossed(gp_Vec(axis.Direction())).Dot(across) / across.SquareMagnitude();
  s.kind = Kind::kCone;
  s.apex = s.origin = p.Translated(t * gp_Vec(line.Direction()));
  s.half_angle = std::acos(std::abs(line.Direction().Dot(axis.Direction())));
  return s;
}

Surface surface_of(const TopoDS_Face& face) {
  const BRepAdaptor_Surface adaptor(face, Standard_False);
  if (adaptor.GetType() != GeomAbs_SurfaceOfRevolution) return surface_of(adaptor);
  const Handle(Adaptor3d_Curve) curve = adaptor.BasisCurve();
  if (curve->GetType() != GeomAbs_Line) return {};
  Surface s = surface_of_turned_line(adaptor.AxeOfRevolution(), curve->Line());
  if (s.kind == Kind::kCone) {
    // To the end that the face is at.
    const BRepAdaptor_Surface part(face);
    const gp_Pnt p = part.Value((part.FirstUParameter() + part.LastUParameter()) / 2,
                                (part.FirstVParameter() + part.LastVParameter()) / 2);
    if (gp_Vec(s.apex, p).Dot(gp_Vec(s.direction)) < 0) s.direction.Reverse();
  }
  return s;
}

// Whether two faces lie on one surface. `near`: a length.
bool same(const Surface& a, const Surface& b, double near) {
  if (a.kind != b.kind || a.kind == Kind::kOther) return false;
  if (std::abs(a.radius - b.radius) > near || std::abs(a.tube_radius - b.tube_radius) > near ||
      std::abs(a.half_angle - b.half_angle) > kSameDirection) {
    return false;
  }
  if (a.kind == Kind::kSphere) return a.origin.Distance(b.origin) <= near;
  if (!a.direction.IsParallel(b.direction, kSameDirection)) return false;
  const gp_Vec apart(a.origin, b.origin);
  const double along = std::abs(apart.Dot(gp_Vec(a.direction)));
  if (a.kind == Kind::kPlane) return along <= near;
  if (a.kind == Kind::kCylinder) return apart.Crossed(gp_Vec(a.direction)).Magnitude() <= near;
  if (a.kind == Kind::kCone && a.direction.Dot(b.direction) < 0) return false;
  return a.origin.Distance(b.origin) <= near;
}

class Tessellation {
 public:
  Tessellation(const Bodies& bodies, const Request& request) : bodies_(bodies), request_(request) {}

  void run() {
    mesh();
    for (std::size_t f = 0; f < bodies_.faces.size(); ++f) {
      add_triangles(f, TopoDS::Face(bodies_.faces[f]));
    }
    if (triangles_.empty()) throw Refusal{Status::kNoShape, "its faces have no area"};
    join_faces();
  }

  void write(const std::string& unit, Answer& answer) const {
    answer.put(Status::kRead);
    answer.put_text(unit);
    answer.put_texts(bodies_.solid_names);
    for (const std::uint32_t n : {bodies_.mended, bodies_.left_out, bodies_.inner_faces}) {
      answer.put(n);
    }
    answer.put(static_cast<std::uint32_t>(joined_.size()));
    for (const std::size_t f : joined_) {
      const Surface& s = surfaces_[f];
      answer.put(s.kind);
      for (const double x : {s.origin.X(), s.origin.Y(), s.origin.Z(), s.direction.X(),
                             s.direction.Y(), s.direction.Z(), s.apex.X(), s.apex.Y(), s.apex.Z(),
                             s.radius, s.tube_radius, s.half_angle}) {
        answer.put(x);
      }
      answer.put_text(label(f).name);
      answer.put(label(f).colour);
    }
    answer.put(static_cast<std::uint64_t>(points_.size()));
    answer.put_all(points_);
    answer.put(static_cast<std::uint64_t>(triangles_.size()));
    answer.put_all(triangles_);
    answer.put_all(face_of_);
  }

 private:
  void mesh() {
    TopoDS_Compound all;
    BRep_Builder builder;
    builder.MakeCompound(all);
    for (const TopoDS_Shape& face : bodies_.faces) builder.Add(all, face);
    Bnd_Box box;
    BRepBndLib::AddClose(all, box);
    if (box.IsVoid() || box.IsOpen()) {
      throw Refusal{Status::kNoShape, "its faces have no bounds"};
    }
    size_ = std::sqrt(box.SquareExtent());
    for (const TopoDS_Shape& face : bodies_.faces) {
      surfaces_.push_back(surface_of(TopoDS::Face(face)));
      const Surface& s = surfaces_.back();
      const double largest = std::max({s.radius, s.tube_radius, std::abs(s.origin.X()),
                                       std::abs(s.origin.Y()), std::abs(s.origin.Z()), size_});
      // Dividing such a face would not end.
      if (!(largest < kLargest)) {
        throw Refusal{Status::kNoShape, "it holds lengths above 1e12 mm"};
      }
    }
    constexpr double kFull = 2 * std::numbers::pi;
    constexpr double kSpare = 1 + 1e-9;  // one chord more for rounding would be out of phase
    const double angle = 2 * std::acos(1 - request_.chord_error_rel);
    IMeshTools_Parameters how;
    how.Angle = kSpare * kFull / (kChordsOfCircle * std::ceil(kFull / (kChordsOfCircle * angle)));
    how.AngleInterior = how.Angle;
    how.Deflection = request_.deflection_rel * size_;
    how.DeflectionInterior = how.Deflection;
    how.MinSize = kLeastChordRel * size_;
    // Another program's own tessellation in the file is not ours.
    how.CleanModel = Standard_True;
    const BRepMesh_IncrementalMesh mesher(all, how);
  }

  [[nodiscard]] FaceLabel label(std::size_t face) const {
    const FaceLabel* found = bodies_.labels.Seek(bodies_.faces[face]);
    return found != nullptr ? *found : FaceLabel{};
  }

  std::int32_t add_point(const gp_Pnt& p) {
    points_.push_back({p.X(), p.Y(), p.Z()});
    return static_cast<std::int32_t>(points_.size() - 1);
  }

  // The vertices of an edge, which all faces at it have: in the order of its curve.
  void share_nodes(const TopoDS_Edge& edge,
                   const Handle(Poly_Triangulation) & mesh,
                   const TopLoc_Location& place,
                   std::vector<std::int32_t>& ids) {
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, mesh, place);
    if (polygon.IsNull()) return;
    const Standard_Integer count = polygon->NbNodes();
    const auto position = [&](Standard_Integer i) {
      return mesh->Node(polygon->Node(i)).Transformed(place.Transformation());
    };
    const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
    std::vector<std::int32_t>* known = edges_.ChangeSeek(forward);
    const bool is_point = BRep_Tool::Degenerated(edge);
    if (known == nullptr || static_cast<Standard_Integer>(known->size()) != count) {
      std::vector<std::int32_t> own;
      const std::int32_t first = vertex_id(TopExp::FirstVertex(forward), position(1));
      const std::int32_t last = vertex_id(TopExp::LastVertex(forward), position(count));
      for (Standard_Integer i = 1; i <= count; ++i) {
        own.push_back(i == 1 || is_point ? first : i == count ? last : add_point(position(i)));
      }
      edges_.Bind(forward, own);
      known = edges_.ChangeSeek(forward);
    }
    for (Standard_Integer i = 1; i <= count; ++i) {
      ids[static_cast<std::size_t>(polygon->Node(i))] = (*known)[static_cast<std::size_t>(i - 1)];
    }
  }

  std::int32_t vertex_id(const TopoDS_Vertex& vertex, const gp_Pnt& p) {
    if (vertex.IsNull()) return add_point(p);
    if (const std::int32_t* id = vertices_.Seek(vertex)) return *id;
    const std::int32_t id = add_point(p);
    vertices_.Bind(vertex, id);
    return id;
  }

  void add_triangles(std::size_t number, const TopoDS_Face& face) {
    TopLoc_Location place;
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, place);
    if (mesh.IsNull()) {
      throw Refusal{Status::kNotTessellated,
                    "face " + std::to_string(number + 1) + " of " +
                        std::to_string(bodies_.faces.size()) +
                        " cannot be divided into triangles; its outline may cross itself"};
    }
    if (triangles_.size() + static_cast<std::size_t>(mesh->NbTriangles()) >
        request_.most_triangles) {
      throw Refusal{Status::kTooLarge,
                    "it takes more than " + std::to_string(request_.most_triangles) + " triangles"};
    }
    std::vector<std::int32_t> ids(static_cast<std::size_t>(mesh->NbNodes()) + 1, -1);
    for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next()) {
      share_nodes(TopoDS::Edge(e.Current()), mesh, place, ids);
    }
    for (Standard_Integer i = 1; i <= mesh->NbNodes(); ++i) {
      std::int32_t& id = ids[static_cast<std::size_t>(i)];
      if (id < 0) id = add_point(mesh->Node(i).Transformed(place.Transformation()));
    }
    const bool reversed = face.Orientation() == TopAbs_REVERSED;
    for (Standard_Integer i = 1; i <= mesh->NbTriangles(); ++i) {
      Standard_Integer a = 0, b = 0, c = 0;
      mesh->Triangle(i).Get(a, b, c);
      if (reversed) std::swap(b, c);
      const std::array<std::int32_t, 3> t{ids[static_cast<std::size_t>(a)],
                                          ids[static_cast<std::size_t>(b)],
                                          ids[static_cast<std::size_t>(c)]};
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      triangles_.push_back(t);
      face_of_.push_back(static_cast<std::int32_t>(number));
    }
  }

  // Halves of cylinders, and planes that an edge divides.
  void join_faces() {
    TopTools_IndexedDataMapOfShapeListOfShape at_edge;
    NCollection_DataMap<TopoDS_Shape, std::size_t, TopTools_ShapeMapHasher> numbers;
    for (std::size_t f = 0; f < bodies_.faces.size(); ++f) {
      numbers.Bind(bodies_.faces[f], f);
      TopExp::MapShapesAndAncestors(bodies_.faces[f], TopAbs_EDGE, TopAbs_FACE, at_edge);
    }
    std::vector<std::size_t> root(bodies_.faces.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t f) {
      while (root[f] != f) f = root[f] = root[root[f]];
      return f;
    };
    for (int e = 1; e <= at_edge.Extent(); ++e) {
      const TopTools_ListOfShape& faces = at_edge.FindFromIndex(e);
      if (faces.Extent() < 2) continue;
      const std::size_t a = numbers.Find(faces.First());
      for (TopTools_ListOfShape::Iterator i(faces); i.More(); i.Next()) {
        const std::size_t b = numbers.Find(i.Value());
        if (find(a) == find(b) || !same(surfaces_[a], surfaces_[b], kSameRel * size_)) continue;
        if (label(a) == label(b)) root[std::max(find(a), find(b))] = std::min(find(a), find(b));
      }
    }
    std::vector<std::int32_t> name(bodies_.faces.size(), -1);
    for (std::size_t f = 0; f < name.size(); ++f) {
      if (find(f) == f) {
        name[f] = static_cast<std::int32_t>(joined_.size());
        joined_.push_back(f);
      }
    }
    for (std::int32_t& f : face_of_) f = name[find(static_cast<std::size_t>(f))];
  }

  const Bodies& bodies_;
  const Request& request_;
  double size_ = 0;
  std::vector<Surface> surfaces_;  // by face
  std::vector<std::array<double, 3>> points_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<std::int32_t> face_of_;  // by triangle
  std::vector<std::size_t> joined_;    // the first of those that are one face
  NCollection_DataMap<TopoDS_Shape, std::vector<std::int32_t>, TopTools_ShapeMapHasher> edges_;
  NCollection_DataMap<TopoDS_Shape, std::int32_t, TopTools_ShapeMapHasher> vertices_;
};

}  // namespace

void write_tessellation(const Bodies& bodies,
                        const std::string& unit,
                        const Request& request,
                        Answer& answer) {
  Tessellation tessellation(bodies, request);
  tessellation.run();
  tessellation.write(unit, answer);
}

}  // namespace symcell::cad
