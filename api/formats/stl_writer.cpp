// STL has no connectivity and, in its binary form, single precision: a model far from the origin
// loses digits there; ASCII keeps them all.
#include <cmath>
#include <limits>

#include "api/formats/mesh_formats.hpp"
#include "core/cell/boundary_faces.hpp"

namespace symcell::internal {
namespace {

// Must not begin with "solid", which is how the ASCII form is recognised.
constexpr std::string_view kTitle = "symcell: boundary of a mesh, binary STL";
constexpr std::size_t kTitleBytes = 80;
constexpr std::uint64_t kMostFaces = std::numeric_limits<std::uint32_t>::max();

using Triangle = std::array<Point3, 3>;

// Zero for a degenerate triangle, which readers take as "not given".
Point3 unit_normal(const Triangle& t) {
  const Point3 n = cross(t[1] - t[0], t[2] - t[0]);
  const double size = length(n);
  return size > 0 ? (1 / size) * n : Point3{};
}

// f(const Triangle&) for every face of every sector.
template <class F>
void each_triangle(const MeshStream& mesh, const std::vector<BoundaryFace>& faces, F f) {
  const SymmetryCellMesh& cell = mesh.cell();
  const FullMeshView& view = mesh.view();
  std::vector<Point3> place(cell.nodes.size());
  for (std::int32_t s = 0; s < mesh.sectors() && !mesh.stopped(); ++s) {
    for (std::size_t i = 0; i < place.size(); ++i) {
      const OrbitVertex v = cell.nodes[i];
      const bool axis = cell.on_axis[static_cast<std::size_t>(v.orbit)] != 0;
      place[i] = view.position({v.orbit, axis ? 0 : view.rotations().add(v.exponent, s)});
    }
    for (const BoundaryFace& face : faces) {
      Triangle t;
      for (std::size_t i = 0; i < 3; ++i) t[i] = place[static_cast<std::size_t>(face.corners[i])];
      f(t);
    }
  }
}

void write_binary(const MeshStream& mesh, const std::vector<BoundaryFace>& faces, ByteWriter& out) {
  out.text(kTitle);
  for (std::size_t i = kTitle.size(); i < kTitleBytes; ++i) out.character(' ');
  out.value(static_cast<std::uint32_t>(faces.size() * static_cast<std::size_t>(mesh.sectors())));
  const auto put = [&out](const Point3& p) {
    for (const double c : {p.x, p.y, p.z}) out.value(static_cast<float>(c));
  };
  each_triangle(mesh, faces, [&](const Triangle& t) {
    put(unit_normal(t));
    for (const Point3& p : t) put(p);
    out.value(std::uint16_t{0});
  });
}

void write_ascii(const MeshStream& mesh, const std::vector<BoundaryFace>& faces, ByteWriter& out) {
  const auto put = [&out](std::string_view word, const Point3& p) {
    out.text(word);
    for (const double c : {p.x, p.y, p.z}) {
      out.character(' ');
      out.real(c);
    }
    out.character('\n');
  };
  out.text("solid symcell\n");
  each_triangle(mesh, faces, [&](const Triangle& t) {
    put("facet normal", unit_normal(t));
    out.text("outer loop\n");
    for (const Point3& p : t) put("vertex", p);
    out.text("endloop\nendfacet\n");
  });
  out.text("endsolid symcell\n");
}

}  // namespace

Result<void> write_stl(const MeshStream& mesh, bool ascii, ByteWriter& out) {
  std::vector<BoundaryFace> faces = boundary_faces(mesh.cell());
  if (mesh.full()) std::erase_if(faces, [](const BoundaryFace& f) { return !f.outer; });
  if (faces.size() > kMostFaces / static_cast<std::size_t>(mesh.sectors())) {
    return fail(ErrorCode::kTooLarge,
                "the boundary has more triangles than an STL file can count; take vtu");
  }
  ascii ? write_ascii(mesh, faces, out) : write_binary(mesh, faces, out);
  return {};
}

}  // namespace symcell::internal
