#include "core/solid/sector/plc_sector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "core/base/assert.hpp"
#include "core/base/index.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::solid {
namespace {

// Angle about the axis in [0, 2 pi).
double angle_of(Point3 p) {
  const double a = std::atan2(p.y, p.x);
  return a < 0 ? a + 2 * std::numbers::pi : a;
}

// A crossing of a segment with line j, the half-plane at start_angle + j * 360/n: its orbit's point
// lies in line 0.
struct Crossing {
  std::int32_t line = 0;  // relative to the segment's first end
  std::int32_t orbit = 0;
};

// A segment orbit: from exponent 0 of one orbit to `turn` of another, its wedges numbered from the
// one of its first end.
struct SegmentPath {
  std::int32_t first_orbit = 0;
  std::int32_t last_orbit = 0;
  std::int32_t turn = 0;
  bool forward = true;              // the angle grows from first to last
  std::vector<Crossing> crossings;  // from first to last
};

class SectorCutter {
 public:
  SectorCutter(const SymmetricPlc& plc, double start_angle, ExecutionContext& context)
      : plc_(plc),
        context_(context),
        fold_(plc.symmetry.fold),
        rotations_(fold_),
        ray_{std::cos(start_angle), std::sin(start_angle)} {
    sector_.fold = fold_;
    sector_.start_angle = start_angle;
  }

  Result<Sector> run() {
    place_orbits();
    cross_segments();
    vertex_index_.assign(2 * sector_.orbit_points.size(), -1);
    for (std::size_t f = 0; f < plc_.facet_orbits.size(); ++f) {
      if (f % 16 == 0) {
        SYMCELL_TRY(context_.check());
      }
      SYMCELL_TRY(cut_facet(static_cast<std::int32_t>(f)));
    }
    add_edges();
    add_lone_points();
    copy_seeds();
    return std::move(sector_);
  }

 private:
  // Moves every orbit's representative into the wedge.
  void place_orbits() {
    const double wedge = 2 * std::numbers::pi / fold_;
    shift_.assign(plc_.orbit_points.size(), 0);
    sector_.orbit_points = plc_.orbit_points;
    sector_.on_axis = plc_.on_axis;
    for (std::size_t o = 0; o < plc_.orbit_points.size(); ++o) {
      if (fold_ == 1 || plc_.on_axis[o] != 0) continue;
      const double turns = (angle_of(plc_.orbit_points[o]) - sector_.start_angle) / wedge;
      shift_[o] = rotations_.reduce(static_cast<std::int64_t>(std::floor(turns)));
      sector_.orbit_points[o] =
          rotations_.rotate(plc_.orbit_points[o], rotations_.reduce(-std::int64_t{shift_[o]}));
    }
    sector_.kinds.assign(plc_.orbit_points.size(), SectorVertexKind::kFixed);
  }

  // The vertex with the number of its wedge as exponent; 0 on the axis.
  [[nodiscard]] OrbitVertex placed(std::int32_t point) const {
    const OrbitVertex v = plc_.vertex[at(point)];
    if (plc_.on_axis[at(v.orbit)] != 0) return v;
    return {v.orbit, rotations_.add(v.exponent, shift_[at(v.orbit)])};
  }
  [[nodiscard]] Point3 position(OrbitVertex v) const {
    return rotations_.rotate(sector_.orbit_points[at(v.orbit)], v.exponent);
  }
  [[nodiscard]] bool axial(std::int32_t orbit) const { return sector_.on_axis[at(orbit)] != 0; }

  // The ends of an edge in the order of its orbit's path.
  [[nodiscard]] std::pair<OrbitVertex, OrbitVertex> ordered_ends(const ComplexEdge& edge) const {
    const OrbitVertex a = placed(edge.a);
    const OrbitVertex b = placed(edge.b);
    if (a.orbit != b.orbit) return a.orbit < b.orbit ? std::pair(a, b) : std::pair(b, a);
    const std::int32_t turn = rotations_.subtract(b.exponent, a.exponent);
    return turn <= fold_ - turn ? std::pair(a, b) : std::pair(b, a);
  }

  void cross_segments() {
    for (const std::int32_t e : plc_.edge_of) {
      const auto [first, last] = ordered_ends(plc_.complex.edges[at(e)]);
      SegmentPath path;
      path.first_orbit = first.orbit;
      path.last_orbit = last.orbit;
      if (fold_ > 1 && !axial(first.orbit) && !axial(last.orbit)) {
        path.turn = rotations_.subtract(last.exponent, first.exponent);
        cross_segment(path);
      }
      paths_.push_back(std::move(path));
    }
  }

  void cross_segment(SegmentPath& path) {
    const Point3 a = sector_.orbit_points[at(path.first_orbit)];
    const Point3 b = position({path.last_orbit, path.turn});
    path.forward = a.x * b.y - a.y * b.x > 0;
    const std::int32_t count = path.forward ? path.turn : rotations_.reduce(fold_ - path.turn);
    for (std::int32_t i = 0; i < count; ++i) {
      const std::int32_t line = path.forward ? i + 1 : rotations_.reduce(-std::int64_t{i});
      const auto turned = [&](std::int32_t orbit, std::int32_t exponent) {
        return position({orbit, rotations_.subtract(exponent, rotations_.reduce(line))});
      };
      path.crossings.push_back(
          {rotations_.reduce(line),
           cross_ray(turned(path.first_orbit, 0), turned(path.last_orbit, path.turn))});
    }
  }

  // The new orbit where the segment crosses the lower half-plane.
  std::int32_t cross_ray(Point3 a, Point3 b) {
    const double above_a = cross(ray_, Point2{a.x, a.y});
    const double above_b = cross(ray_, Point2{b.x, b.y});
    const double t = above_a / (above_a - above_b);
    const double radius_a = dot(ray_, Point2{a.x, a.y});
    const double radius_b = dot(ray_, Point2{b.x, b.y});
    const double radius = radius_a + t * (radius_b - radius_a);
    const auto orbit = static_cast<std::int32_t>(sector_.orbit_points.size());
    sector_.orbit_points.push_back({radius * ray_.x, radius * ray_.y, a.z + t * (b.z - a.z)});
    sector_.on_axis.push_back(0);
    sector_.kinds.push_back(SectorVertexKind::kOnSegment);
    return orbit;
  }

  // A representative facet with all half-planes' lines in it, at its place in the model.
  struct Facet {
    std::vector<OrbitVertex> vertices;  // crossings: exponent is the line
    std::vector<Point3> points;
    FacetGraph graph;
    std::vector<std::int32_t> cut_line;  // per cut
  };

  Result<void> cut_facet(std::int32_t index) {
    const FacetOrbit& orbit = plc_.facet_orbits[at(index)];
    const ComplexFacet& source = plc_.complex.facets[at(orbit.facet)];
    Facet facet = facet_with_lines(source);
    auto cut = triangulate_facet(facet.points, facet.graph);
    if (!cut) {
      return fail(ErrorCode::kInternal,
                  "facet " + std::to_string(source.source) +
                      " cannot be cut into sectors at this angle: " + cut.error().message,
                  {source.source});
    }
    const std::vector<std::int32_t> wedges = wedges_of(facet, *cut);
    const std::int32_t span = fold_ / orbit.self_copies;
    for (std::size_t t = 0; t < cut->triangles.size(); ++t) {
      const std::int32_t wedge = wedges[at(cut->piece[t])];
      if (wedge < 0) {
        return fail(ErrorCode::kInternal, "a piece of facet " + std::to_string(source.source) +
                                              " lies in no sector at this angle");
      }
      if (wedge >= span) continue;
      SectorFace face;
      for (std::size_t i = 0; i < 3; ++i) {
        face.v[i] = sector_vertex(facet.vertices[at(cut->triangles[t][i])], wedge);
      }
      face.facet = index;
      sector_.faces.push_back(face);
    }
    for (std::size_t c = 0; c < facet.graph.cuts.size(); ++c) {
      const std::int32_t line = facet.cut_line[c];
      if (cut->cut_sides[c] == 0 || line >= span) continue;
      const IndexPair ends = facet.graph.cuts[c];
      sector_.lower_cut.push_back({sector_vertex(facet.vertices[at(ends[0])], line),
                                   sector_vertex(facet.vertices[at(ends[1])], line)});
    }
    sector_.facet_markers.push_back(source.marker);
    return {};
  }

  Facet facet_with_lines(const ComplexFacet& source) {
    Facet facet;
    facet.graph.normal = source.graph.normal;
    facet.graph.holes = source.graph.holes;
    std::vector<std::pair<std::int32_t, std::int32_t>> local;  // (point of the complex, here)
    for (const IndexPair& s : source.graph.segments) {
      for (const std::int32_t point : s) local.emplace_back(point, 0);
    }
    for (const std::int32_t point : source.graph.points) local.emplace_back(point, 0);
    std::sort(local.begin(), local.end());
    local.erase(std::unique(local.begin(), local.end()), local.end());
    for (auto& [point, here] : local) here = add_vertex(facet, placed(point));
    const auto here = [&](std::int32_t point) {
      return std::lower_bound(local.begin(), local.end(), std::pair(point, 0))->second;
    };
    for (const std::int32_t point : source.graph.points) facet.graph.points.push_back(here(point));

    struct OnLine {
      std::int32_t line;
      double along;
      std::int32_t vertex;
    };
    std::vector<OnLine> on_lines;
    for (std::size_t s = 0; s < source.graph.segments.size(); ++s) {
      const std::int32_t e = source.edges[s];
      const auto& edge = plc_.complex.edges[at(e)];
      const auto [first, last] = ordered_ends(edge);
      const SegmentPath& path = paths_[at(plc_.edge_orbit[at(e)])];
      const bool straight = placed(edge.a) == first;
      std::int32_t from = here(straight ? edge.a : edge.b);
      for (const Crossing& crossing : path.crossings) {
        const std::int32_t line = rotations_.add(crossing.line, first.exponent);
        const std::int32_t v = add_vertex(facet, {crossing.orbit, line});
        facet.graph.segments.push_back({from, v});
        on_lines.push_back({line, 0, v});
        from = v;
      }
      facet.graph.segments.push_back({from, here(straight ? edge.b : edge.a)});
    }

    std::int32_t axis_vertex = -1;
    std::int32_t axis_count = 0;
    for (std::size_t v = 0; v < facet.vertices.size(); ++v) {
      if (!axial(facet.vertices[v].orbit)) continue;
      axis_vertex = static_cast<std::int32_t>(v);
      ++axis_count;
    }
    for (OnLine& p : on_lines) p.along = along_line(facet, p.line, p.vertex);
    std::sort(on_lines.begin(), on_lines.end(), [](const OnLine& p, const OnLine& q) {
      return std::tie(p.line, p.along, p.vertex) < std::tie(q.line, q.along, q.vertex);
    });
    for (std::size_t begin = 0; begin < on_lines.size();) {
      std::vector<std::int32_t> chain;
      std::size_t end = begin;
      for (; end < on_lines.size() && on_lines[end].line == on_lines[begin].line; ++end) {
        chain.push_back(on_lines[end].vertex);
      }
      // A facet that meets the axis in one point is met by each half-plane in a ray from there.
      if (axis_count == 1) {
        const double along = along_line(facet, on_lines[begin].line, axis_vertex);
        if (along < on_lines[begin].along) {
          chain.insert(chain.begin(), axis_vertex);
        } else {
          chain.push_back(axis_vertex);
        }
      }
      for (std::size_t i = 1; i < chain.size(); ++i) {
        facet.graph.cuts.push_back({chain[i - 1], chain[i]});
        facet.cut_line.push_back(on_lines[begin].line);
      }
      begin = end;
    }
    return facet;
  }

  std::int32_t add_vertex(Facet& facet, OrbitVertex v) const {
    facet.vertices.push_back(v);
    facet.points.push_back(position(v));
    return static_cast<std::int32_t>(facet.vertices.size()) - 1;
  }

  // Place along the line in which the half-plane meets the facet's plane.
  [[nodiscard]] double along_line(const Facet& facet, std::int32_t line, std::int32_t v) const {
    const Point2 ray = rotations_.rotate(ray_, line);
    return dot(cross(facet.graph.normal, Point3{-ray.y, ray.x, 0}), facet.points[at(v)]);
  }

  // Per piece of the facet the wedge it lies in, -1 if none does. A vertex off the lines is in one
  // wedge, one on line j in wedges j - 1 and j, one on the axis in all.
  [[nodiscard]] std::vector<std::int32_t> wedges_of(const Facet& facet,
                                                    const FacetTriangles& cut) const {
    struct Choice {
      std::int32_t low = -1;  // -1: nothing known yet
      std::int32_t high = -1;
      double area = -1;
      double angle = 0;  // of the centre of the largest triangle
      bool failed = false;
    };
    const auto crossings_from = static_cast<std::int32_t>(plc_.orbit_points.size());
    std::vector<Choice> choices(at(cut.piece_count));
    for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
      Choice& c = choices[at(cut.piece[t])];
      const auto& tri = cut.triangles[t];
      for (const std::int32_t i : tri) {
        const OrbitVertex v = facet.vertices[at(i)];
        if (axial(v.orbit)) continue;
        const std::int32_t high = v.exponent;
        const std::int32_t low =
            v.orbit >= crossings_from ? rotations_.subtract(high, 1 % fold_) : high;
        if (c.low < 0) {
          c.low = low;
          c.high = high;
          continue;
        }
        const bool keep_low = c.low == low || c.low == high;
        const bool keep_high = c.high == low || c.high == high;
        if (!keep_low && !keep_high) c.failed = true;
        if (!keep_low) c.low = c.high;
        if (!keep_high) c.high = c.low;
      }
      const Point3 p = facet.points[at(tri[0])];
      const Point3 q = facet.points[at(tri[1])];
      const Point3 r = facet.points[at(tri[2])];
      const double area = squared_length(cross(q - p, r - p));
      if (area <= c.area) continue;
      c.area = area;
      c.angle = angle_of(p + q + r);
    }
    std::vector<std::int32_t> result;
    for (const Choice& c : choices) {
      if (c.low == c.high || c.failed) {
        result.push_back(c.failed ? -1 : c.low);
        continue;
      }
      const double turns =
          (c.angle - sector_.start_angle) / (2 * std::numbers::pi / static_cast<double>(fold_));
      const std::int32_t wedge = rotations_.reduce(static_cast<std::int64_t>(std::floor(turns)));
      result.push_back(wedge == c.low || wedge == c.high ? wedge : -1);
    }
    return result;
  }

  // The sector vertex of a vertex seen from a wedge.
  std::int32_t sector_vertex(OrbitVertex v, std::int32_t wedge) {
    const std::int32_t exponent = axial(v.orbit) ? 0 : rotations_.subtract(v.exponent, wedge);
    SYMCELL_ASSERT(exponent == 0 || exponent == 1);
    std::int32_t& index = vertex_index_[at(2 * v.orbit + exponent)];
    if (index < 0) {
      index = static_cast<std::int32_t>(sector_.vertices.size());
      sector_.vertices.push_back({v.orbit, exponent});
    }
    return index;
  }

  void add_edges() {
    for (std::size_t s = 0; s < paths_.size(); ++s) {
      const SegmentPath& path = paths_[s];
      const auto segment = static_cast<std::int32_t>(s);
      std::int32_t wedge = 0;
      OrbitVertex from{path.first_orbit, 0};
      for (const Crossing& crossing : path.crossings) {
        const OrbitVertex to{crossing.orbit, crossing.line};
        sector_.edges.push_back({sector_vertex(from, wedge), sector_vertex(to, wedge), segment});
        wedge = path.forward ? rotations_.add(wedge, 1) : rotations_.subtract(wedge, 1);
        from = to;
      }
      sector_.edges.push_back({sector_vertex(from, wedge),
                               sector_vertex({path.last_orbit, path.turn}, wedge), segment});
      sector_.segment_markers.push_back(plc_.complex.edges[at(plc_.edge_of[s])].marker);
    }
  }

  // Vertices that no facet or segment has.
  void add_lone_points() {
    for (std::size_t o = 0; o < plc_.orbit_points.size(); ++o) {
      if (vertex_index_[2 * o] < 0) sector_vertex({static_cast<std::int32_t>(o), 0}, 0);
    }
  }

  void copy_seeds() {
    sector_.holes = plc_.complex.holes;
    for (const PlcRegion& r : plc_.complex.regions) {
      sector_.regions.push_back({r.point, r.attribute, r.max_volume});
    }
    sector_.ignore_markers = plc_.ignore_markers;
    sector_.expected_volume = plc_.volume;
  }

  const SymmetricPlc& plc_;
  ExecutionContext& context_;
  std::int32_t fold_;
  RotationTable rotations_;
  Point2 ray_;  // of the lower half-plane
  Sector sector_;
  std::vector<std::int32_t> shift_;         // per orbit of the PLC: the wedge its point lay in
  std::vector<SegmentPath> paths_;          // per edge orbit
  std::vector<std::int32_t> vertex_index_;  // 2 * orbit + exponent -> sector vertex
};

}  // namespace

Result<Sector> cut_sector(const SymmetricPlc& plc, double start_angle, ExecutionContext& context) {
  return SectorCutter(plc, start_angle, context).run();
}

}  // namespace symcell::solid
