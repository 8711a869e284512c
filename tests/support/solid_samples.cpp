#include "tests/support/solid_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/assert.hpp"
#include "core/base/random.hpp"
#include "core/solid/quotient/lifted_predicates.hpp"

namespace symcell::test {
namespace {

// Segments: axis, bottom and top rims (outer, inner), upright edges (outer, inner).
constexpr std::int32_t kAxisSegment = 0;

std::size_t idx(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

class PrismBuilder {
 public:
  explicit PrismBuilder(const PrismShape& shape) : s_(shape), hole_(shape.inner_radius > 0) {}

  solid::InitialTetrahedralization build() {
    out_.mesh = solid::QuotientTetrahedralization(s_.fold);
    const std::int32_t facets = 2 + s_.steps * (hole_ ? 2 : 1) + (s_.inner_facet ? 1 : 0);
    for (std::int32_t f = 0; f < facets; ++f) out_.facet_markers.push_back(f + 1);
    plate_ = facets - 1;
    out_.segment_markers.assign(1 + 6 * idx(s_.steps), 0);
    out_.subdomains = {{7, 1e300}};
    if (s_.inner_facet) out_.subdomains.push_back({8, 1e300});
    add_vertices();
    add_tets();
    SYMCELL_ASSERT(out_.mesh.build(tets_));
    add_segments();
    return std::move(out_);
  }

 private:
  // A column of vertices: ring i, place j (any integer; steps make a sector). i < 0: the axis.
  struct Column {
    std::int32_t i, j;
    bool operator<(const Column& o) const { return i != o.i ? i < o.i : j < o.j; }
  };

  [[nodiscard]] std::int32_t first_ring() const { return hole_ ? 0 : 1; }
  [[nodiscard]] bool is_axis(Column c) const { return c.i < first_ring(); }
  [[nodiscard]] bool is_outer(Column c) const { return c.i == s_.rings; }
  [[nodiscard]] bool is_inner(Column c) const { return hole_ && c.i == 0; }

  void add_vertices() {
    solid::QuotientTetrahedralization& mesh = out_.mesh;
    for (std::int32_t layer = 0; layer <= s_.layers; ++layer) {
      const double z = s_.height * layer / s_.layers;
      const bool end = layer == 0 || layer == s_.layers;
      const bool plate = s_.inner_facet && 2 * layer == s_.layers;
      if (!hole_) {
        const bool axis = s_.fold > 1;
        if (!axis && (end || plate)) {
          mesh.add_vertex({0, 0, z}, solid::VertexKind::kFacet, false,
                          plate        ? plate_
                          : layer == 0 ? 0
                                       : 1);
        } else if (end || plate) {
          mesh.add_vertex({0, 0, z}, solid::VertexKind::kInput, true);
        } else if (axis) {
          mesh.add_vertex({0, 0, z}, solid::VertexKind::kSegment, true, kAxisSegment);
        } else {
          mesh.add_vertex({0, 0, z}, solid::VertexKind::kFree, false);
        }
      }
      for (std::int32_t i = first_ring(); i <= s_.rings; ++i) {
        for (std::int32_t j = 0; j < s_.steps; ++j) {
          const Column c{i, j};
          const double t = static_cast<double>(i) / s_.rings;
          const double radius = s_.inner_radius + t * (s_.outer_radius - s_.inner_radius);
          const bool side = is_outer(c) || is_inner(c);
          const double angle =
              2 * std::numbers::pi * j / (static_cast<double>(s_.fold) * s_.steps) +
              (side ? 0 : s_.swirl * (s_.rings - i));
          const Point3 p{radius * std::cos(angle), radius * std::sin(angle), z};
          if (side && (end || plate)) {
            mesh.add_vertex(p, solid::VertexKind::kInput, false);
          } else if (side) {
            mesh.add_vertex(p, solid::VertexKind::kSegment, false, upright(c));
          } else if (end || plate) {
            mesh.add_vertex(p, solid::VertexKind::kFacet, false,
                            plate        ? plate_
                            : layer == 0 ? 0
                                         : 1);
          } else {
            mesh.add_vertex(p, solid::VertexKind::kFree, false);
          }
        }
      }
    }
  }

  [[nodiscard]] std::int32_t place(std::int32_t j) const {
    return (j % s_.steps + s_.steps) % s_.steps;
  }
  [[nodiscard]] std::int32_t rim(Column c, bool top) const {
    return 1 + (is_outer(c) ? 0 : 2 * s_.steps) + (top ? s_.steps : 0) + place(c.j);
  }
  [[nodiscard]] std::int32_t upright(Column c) const {
    return 1 + 4 * s_.steps + (is_outer(c) ? 0 : s_.steps) + place(c.j);
  }

  [[nodiscard]] OrbitVertex corner(Column c, std::int32_t layer) const {
    const std::int32_t rings = s_.rings - first_ring() + 1;
    const std::int32_t base = layer * (rings * s_.steps + (hole_ ? 0 : 1));
    if (is_axis(c)) return {base, 0};
    const std::int32_t j = place(c.j);
    return {base + (hole_ ? 0 : 1) + (c.i - first_ring()) * s_.steps + j,
            out_.mesh.rotations().reduce((c.j - j) / s_.steps)};
  }

  void add_tets() {
    for (std::int32_t layer = 0; layer < s_.layers; ++layer) {
      for (std::int32_t j = 0; j < s_.steps; ++j) {
        if (!hole_) add_prism({0, 0}, {1, j}, {1, j + 1}, layer);
        for (std::int32_t i = first_ring(); i < s_.rings; ++i) {
          add_prism({i, j}, {i + 1, j}, {i + 1, j + 1}, layer);
          add_prism({i, j}, {i + 1, j + 1}, {i, j + 1}, layer);
        }
      }
    }
  }

  // Each upright quadrilateral gets the diagonal from the smaller column's foot: so neighbours, in
  // other sectors too, agree.
  void add_prism(Column a, Column b, Column c, std::int32_t layer) {
    std::array<Column, 3> column{a, b, c};
    std::sort(column.begin(), column.end());
    struct Corner3 {
      Column column;
      std::int32_t up;
    };
    for (std::size_t turn = 0; turn < 3; ++turn) {
      // Feet of the columns 0 .. 2 - turn, heads of the columns 2 - turn .. 2.
      std::array<Corner3, 4> c3{};
      std::size_t n = 0;
      for (std::size_t m = 0; m + turn <= 2; ++m) c3[n++] = {column[m], 0};
      for (std::size_t m = 2 - turn; m <= 2; ++m) c3[n++] = {column[m], 1};
      solid::NewTet t;
      const auto fill = [&] {
        for (std::size_t i = 0; i < 4; ++i) t.c[i] = corner(c3[i].column, layer + c3[i].up);
      };
      fill();
      const auto at = [&](std::size_t i) { return out_.mesh.lift(t.c[i]); };
      if (orientation_3(at(0), at(1), at(2), at(3)) == Sign::kNegative) {
        std::swap(c3[2], c3[3]);
        fill();
      }
      t.region = s_.inner_facet && 2 * layer >= s_.layers ? 1 : 0;
      for (std::size_t f = 0; f < 4; ++f) {
        t.facet[f] =
            facet(c3[solid::kFaceCorners[f][0]].column, layer + c3[solid::kFaceCorners[f][0]].up,
                  c3[solid::kFaceCorners[f][1]].column, layer + c3[solid::kFaceCorners[f][1]].up,
                  c3[solid::kFaceCorners[f][2]].column, layer + c3[solid::kFaceCorners[f][2]].up);
      }
      tets_.push_back(t);
    }
  }

  [[nodiscard]] std::int32_t facet(
      Column a, std::int32_t za, Column b, std::int32_t zb, Column c, std::int32_t zc) const {
    if (za == zb && zb == zc) {
      if (za == 0) return 0;
      if (za == s_.layers) return 1;
      return s_.inner_facet && 2 * za == s_.layers ? plate_ : solid::kNoFacet;
    }
    const std::int32_t j = std::min({a.j, b.j, c.j});
    if (is_outer(a) && is_outer(b) && is_outer(c)) return 2 + place(j);
    if (is_inner(a) && is_inner(b) && is_inner(c)) return 2 + s_.steps + place(j);
    return solid::kNoFacet;
  }

  void add_segments() {
    solid::QuotientTetrahedralization& mesh = out_.mesh;
    const auto set = [&](OrbitVertex a, OrbitVertex b, std::int32_t segment) {
      mesh.set_segment(mesh.edge_key(a, b), segment);
    };
    for (std::int32_t layer = 0; layer <= s_.layers; ++layer) {
      const bool end = layer == 0 || layer == s_.layers;
      const bool plate = s_.inner_facet && 2 * layer == s_.layers;
      const bool up = layer < s_.layers;
      if (!hole_ && up && s_.fold > 1) {
        set(corner({0, 0}, layer), corner({0, 0}, layer + 1), kAxisSegment);
      }
      for (const std::int32_t i : {0, s_.rings}) {
        if (i == 0 && !hole_) continue;
        for (std::int32_t j = 0; j < s_.steps; ++j) {
          const Column c{i, j}, next{i, j + 1};
          if (end || plate) set(corner(c, layer), corner(next, layer), rim(c, layer != 0));
          if (up) set(corner(c, layer), corner(c, layer + 1), upright(c));
        }
      }
    }
  }

  PrismShape s_;
  bool hole_;
  std::int32_t plate_ = 0;
  solid::InitialTetrahedralization out_;
  std::vector<solid::NewTet> tets_;
};

std::vector<OrbitVertex> others(const solid::QuotientTetrahedralization& mesh,
                                solid::TetCopy c,
                                OrbitVertex a,
                                OrbitVertex b) {
  std::vector<OrbitVertex> result;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const OrbitVertex x = mesh.corner(c, i);
    if (!(x == a) && !(x == b)) result.push_back(x);
  }
  return result;
}

// Not flat either: 6 V against the longest edge cubed.
bool positive(const solid::QuotientTetrahedralization& mesh, const solid::NewTet& t) {
  constexpr double kLeastVolume = 1e-6;
  const Point3 a = mesh.lift(t.c[0]);
  const Point3 u = mesh.lift(t.c[1]) - a, v = mesh.lift(t.c[2]) - a, w = mesh.lift(t.c[3]) - a;
  const double longest =
      std::max({length(u), length(v), length(w), length(v - u), length(w - u), length(w - v)});
  return dot(cross(u, v), w) > kLeastVolume * longest * longest * longest;
}

// Replaces the two tetrahedra at a face by three round the new edge.
bool flip_23(solid::QuotientTetrahedralization& mesh, solid::TetId t, std::uint32_t i) {
  const solid::Tet& tet = mesh.tet(t);
  if (tet.nb[i] == solid::kNoHalfFace || tet.facet[i] != solid::kNoFacet ||
      solid::tet_of(tet.nb[i]) == t)
    return false;
  const solid::TetCopy g = mesh.neighbour({t, 0}, i);
  const OrbitVertex top = mesh.corner(t, i), foot = mesh.corner(g, solid::face_of(tet.nb[i]));
  std::array<solid::NewTet, 3> added;
  for (std::uint32_t m = 0; m < 3; ++m) {
    solid::NewTet& n = added[m];
    n.c[0] = mesh.corner(t, solid::kFaceCorners[i][m]);
    n.c[1] = mesh.corner(t, solid::kFaceCorners[i][(m + 1) % 3]);
    n.c[2] = foot;
    n.c[3] = top;
    n.region = tet.region;
    if (!positive(mesh, n)) std::swap(n.c[2], n.c[3]);
    if (!positive(mesh, n)) return false;
  }
  // All on one side of the new edge each: the two tetrahedra make a convex body.
  for (std::uint32_t m = 0; m < 3; ++m) {
    const OrbitVertex a = mesh.corner(t, solid::kFaceCorners[i][m]);
    const OrbitVertex b = mesh.corner(t, solid::kFaceCorners[i][(m + 1) % 3]);
    if (orientation_3(mesh, foot, top, a, b) !=
        orientation_3(mesh, foot, top, mesh.corner(t, solid::kFaceCorners[i][0]),
                      mesh.corner(t, solid::kFaceCorners[i][1]))) {
      return false;
    }
  }
  const std::array<solid::TetCopy, 2> removed{solid::TetCopy{t, 0}, g};
  return mesh.replace(removed, added);
}

// Replaces three tetrahedra round an edge by two.
bool flip_32(solid::QuotientTetrahedralization& mesh, solid::TetId t, std::uint32_t e) {
  const OrbitVertex a = mesh.corner(t, solid::kEdgeCorners[e][0]),
                    b = mesh.corner(t, solid::kEdgeCorners[e][1]);
  if (mesh.edges().find(mesh.edge_key(a, b)) != solid::kNoSegment) return false;
  if (mesh.on_axis(a.orbit) && mesh.on_axis(b.orbit)) return false;
  std::vector<solid::TetCopy> ring;
  if (!mesh.ring({t, 0}, a, b, ring) || ring.size() != 3) return false;
  std::vector<OrbitVertex> rim = others(mesh, ring[0], a, b);
  for (const OrbitVertex& x : others(mesh, ring[1], a, b)) {
    if (!(x == rim[0]) && !(x == rim[1])) rim.push_back(x);
  }
  if (rim.size() != 3) return false;
  for (const solid::TetCopy& c : ring) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (mesh.tet(c.t).facet[i] == solid::kNoFacet) continue;
      const OrbitVertex x = mesh.corner(c, i);
      if (!(x == a) && !(x == b)) return false;  // a facet at the edge
    }
  }
  std::array<solid::NewTet, 2> added;
  for (std::size_t m = 0; m < 2; ++m) {
    solid::NewTet& n = added[m];
    n.c[0] = rim[0];
    n.c[1] = rim[1];
    n.c[2] = rim[2];
    n.c[3] = m == 0 ? a : b;
    n.region = mesh.tet(t).region;
    if (!positive(mesh, n)) std::swap(n.c[0], n.c[1]);
    if (!positive(mesh, n)) return false;
    if (orientation_3(mesh, n.c[0], n.c[1], n.c[2], m == 0 ? b : a) != Sign::kNegative)
      return false;
  }
  return mesh.replace(ring, added);
}

}  // namespace

solid::InitialTetrahedralization prism(const PrismShape& shape) {
  return PrismBuilder(shape).build();
}

Plc prism_model(const PrismShape& s) {
  Plc plc;
  const RotationTable rotations(s.fold);
  const std::int32_t sides = s.fold * s.steps;
  const auto add_polygon = [&](double radius, double z) {
    std::vector<std::int32_t> polygon;
    for (std::int32_t k = 0; k < s.fold; ++k) {
      for (std::int32_t j = 0; j < s.steps; ++j) {
        const double angle = 2 * std::numbers::pi * j / static_cast<double>(sides);
        polygon.push_back(static_cast<std::int32_t>(plc.vertices.size()));
        plc.vertices.push_back(
            rotations.rotate(Point3{radius * std::cos(angle), radius * std::sin(angle), z}, k));
      }
    }
    return polygon;
  };
  const std::size_t levels = s.inner_facet ? 3 : 2;
  std::vector<std::vector<std::vector<std::int32_t>>> polygons(levels);
  for (std::size_t level = 0; level < levels; ++level) {
    const double z = s.height * static_cast<double>(level) / static_cast<double>(levels - 1);
    polygons[level].push_back(add_polygon(s.outer_radius, z));
    if (s.inner_radius > 0) polygons[level].push_back(add_polygon(s.inner_radius, z));
    PlcFacet facet;
    facet.polygons = polygons[level];
    if (s.inner_radius > 0) facet.holes.push_back({0, 0, z});
    const bool top = level + 1 == levels;
    const std::int32_t count = 2 + s.steps * (s.inner_radius > 0 ? 2 : 1) + (levels == 3 ? 1 : 0);
    facet.marker = level == 0 ? 1 : top ? 2 : count;
    plc.facets.push_back(facet);
  }
  for (std::size_t level = 0; level + 1 < levels; ++level) {
    for (std::size_t p = 0; p < polygons[0].size(); ++p) {
      for (std::int32_t j = 0; j < sides; ++j) {
        const std::size_t a = idx(j), b = idx((j + 1) % sides);
        PlcFacet facet;
        facet.polygons = {{polygons[level][p][a], polygons[level][p][b], polygons[level + 1][p][b],
                           polygons[level + 1][p][a]}};
        facet.marker = 3 + j % s.steps + (p == 1 ? s.steps : 0);
        plc.facets.push_back(facet);
      }
    }
  }
  if (s.inner_radius > 0) {
    // The void is not enclosed: no volume hole is needed.
    const double r = 0.5 * (s.inner_radius + s.outer_radius);  // between two corners
    plc.regions.push_back({{r, 0, 0.25 * s.height}, 7, PlcRegion{}.max_volume});
    if (s.inner_facet) plc.regions.push_back({{r, 0, 0.75 * s.height}, 8, PlcRegion{}.max_volume});
  } else {
    plc.regions.push_back({{0, 0, 0.25 * s.height}, 7, PlcRegion{}.max_volume});
    if (s.inner_facet) plc.regions.push_back({{0, 0, 0.75 * s.height}, 8, PlcRegion{}.max_volume});
  }
  return plc;
}

double prism_volume(const PrismShape& s) {
  const double sides = static_cast<double>(s.fold) * s.steps;
  const double area = 0.5 * sides * std::sin(2 * std::numbers::pi / sides) *
                      (s.outer_radius * s.outer_radius - s.inner_radius * s.inner_radius);
  return area * s.height;
}

void shuffle_gauge(solid::QuotientTetrahedralization& mesh, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::int32_t> turn(mesh.tet_slots());
  for (std::int32_t& x : turn) {
    x = mesh.rotations().reduce(static_cast<std::int64_t>(random.next() >> 33));
  }
  for (solid::TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    solid::Tet& tet = mesh.tet(t);
    for (std::uint32_t i = 0; i < 4; ++i) {
      tet.k[i] = static_cast<std::int16_t>(mesh.shift(tet.v[i], tet.k[i], turn[t]));
      if (tet.nb[i] == solid::kNoHalfFace) continue;
      tet.off[i] = static_cast<std::int16_t>(
          mesh.subtract(mesh.add(tet.off[i], turn[t]), turn[solid::tet_of(tet.nb[i])]));
    }
  }
}

void jitter(solid::QuotientTetrahedralization& mesh, double share, std::uint64_t seed) {
  Random random(seed);
  std::vector<solid::TetCopy> star;
  for (std::size_t i = 0; i < mesh.vertex_slots(); ++i) {
    const auto v = static_cast<VertexId>(i);
    if (mesh.kind(v) != solid::VertexKind::kFree || mesh.on_axis(v)) continue;
    star.clear();
    mesh.star(v, star);
    const Point3 p = mesh.point(v);
    double shortest = 1e300;
    for (const solid::TetCopy& c : star) {
      for (std::uint32_t m = 0; m < 4; ++m) {
        const double d = squared_distance(p, mesh.lift(mesh.corner(c, m)));
        if (d > 0) shortest = std::min(shortest, d);
      }
    }
    const double step = share * std::sqrt(shortest);
    mesh.move_vertex(
        v, {p.x + step * (2 * random.uniform() - 1), p.y + step * (2 * random.uniform() - 1),
            p.z + step * (2 * random.uniform() - 1)});
    const bool good = std::all_of(star.begin(), star.end(), [&](const solid::TetCopy& c) {
      return orientation_3(mesh, mesh.corner(c.t, 0), mesh.corner(c.t, 1), mesh.corner(c.t, 2),
                           mesh.corner(c.t, 3)) == Sign::kPositive;
    });
    if (!good) mesh.move_vertex(v, p);
  }
}

int random_flips(solid::QuotientTetrahedralization& mesh, int tries, std::uint64_t seed) {
  Random random(seed);
  int done = 0;
  for (int i = 0; i < tries; ++i) {
    const auto t = static_cast<solid::TetId>(random.next() % mesh.tet_slots());
    const auto place = static_cast<std::uint32_t>(random.next() % 10);
    if (!mesh.alive(t)) continue;
    done += (place < 4 ? flip_23(mesh, t, place) : flip_32(mesh, t, place - 4)) ? 1 : 0;
  }
  return done;
}

}  // namespace symcell::test
