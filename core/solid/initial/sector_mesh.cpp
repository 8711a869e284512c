#include "core/solid/initial/sector_mesh.hpp"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/rotation.hpp"
#include "core/solid/initial/tetgen.hpp"

namespace symcell::solid::initial {
namespace {

Failure failed(const std::string& why) {
  return fail(ErrorCode::kTetrahedralizationFailed, "tetrahedralization of the sector: " + why);
}

using Edge = std::array<std::int32_t, 2>;

Edge sorted(Edge e) {
  return e[0] < e[1] ? e : Edge{e[1], e[0]};
}

template <class Range>
void append_sides(const Range& triangles, std::vector<Edge>& sides) {
  for (const auto& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) sides.push_back(sorted({t[i], t[(i + 1) % 3]}));
  }
}

void sort_unique(std::vector<Edge>& edges) {
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

TriangleComplex make_complex(const Sector& sector, const CutSection& section) {
  TriangleComplex complex;
  const RotationTable rotations(sector.fold);
  for (const OrbitVertex v : sector.vertices) {
    complex.points.push_back(rotations.rotate(sector.orbit_points[at(v.orbit)], v.exponent));
  }
  for (const SectorFace& f : sector.faces) complex.triangles.push_back(f.v);
  for (const auto& f : section.faces) complex.triangles.push_back(f);
  for (const auto& [a, b, c] : section.faces) {
    complex.triangles.push_back({section.image[at(a)], section.image[at(b)], section.image[at(c)]});
  }
  std::vector<Edge> sides;
  append_sides(complex.triangles, sides);
  sort_unique(sides);
  std::vector<Edge> free;
  for (const SectorEdge& e : sector.edges) {
    const Edge edge = sorted({e.a, e.b});
    if (!std::binary_search(sides.begin(), sides.end(), edge)) free.push_back(edge);
  }
  sort_unique(free);
  complex.edges = std::move(free);
  return complex;
}

// A half-face (source >= 0) or a face that must be there (source = -1 - label), by its corners.
struct KeyedSource {
  std::array<std::int32_t, 3> corners;
  std::int64_t source;
  bool operator<(const KeyedSource& o) const {
    return std::tie(corners, source) < std::tie(o.corners, o.source);
  }
};

std::array<std::int32_t, 3> sorted(std::array<std::int32_t, 3> c) {
  std::sort(c.begin(), c.end());
  return c;
}

// Links the tetrahedra and labels their faces.
Result<void> link(const std::vector<std::array<std::int32_t, 3>>& triangles, SectorMesh& mesh) {
  std::vector<KeyedSource> faces;
  faces.reserve(4 * mesh.tets.size() + triangles.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& c = kFaceCorners[i];
      const auto& v = mesh.tets[t];
      faces.push_back(
          {sorted(std::array{v[c[0]], v[c[1]], v[c[2]]}), static_cast<std::int64_t>(4 * t + i)});
    }
  }
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    faces.push_back({sorted(triangles[f]), -1 - static_cast<std::int64_t>(f)});
  }
  std::sort(faces.begin(), faces.end());
  mesh.nb.assign(mesh.tets.size(), {kNoHalfFace, kNoHalfFace, kNoHalfFace, kNoHalfFace});
  mesh.label.assign(mesh.tets.size(), {kNoLabel, kNoLabel, kNoLabel, kNoLabel});
  std::size_t missing = 0;
  for (std::size_t begin = 0; begin < faces.size();) {
    std::size_t end = begin;
    std::int32_t label = kNoLabel;
    std::vector<HalfFace> sides;
    for (; end < faces.size() && faces[end].corners == faces[begin].corners; ++end) {
      if (faces[end].source < 0) {
        if (label != kNoLabel) return failed("a face occurs twice");
        label = static_cast<std::int32_t>(-1 - faces[end].source);
      } else {
        sides.push_back(static_cast<HalfFace>(faces[end].source));
      }
    }
    begin = end;
    if (sides.size() > 2) return failed("the result is no complex");
    if (sides.empty()) ++missing;
    for (const HalfFace h : sides) mesh.label[tet_of(h)][face_of(h)] = label;
    if (sides.size() == 2) {
      mesh.nb[tet_of(sides[0])][face_of(sides[0])] = sides[1];
      mesh.nb[tet_of(sides[1])][face_of(sides[1])] = sides[0];
    }
  }
  if (missing > 0) {
    return failed(std::to_string(missing) + " of " + std::to_string(triangles.size()) +
                  " faces were lost");
  }
  return {};
}

bool has_edges(const SectorMesh& mesh, const std::vector<Edge>& edges) {
  std::vector<bool> found(edges.size(), false);
  if (edges.empty()) return true;
  for (const auto& v : mesh.tets) {
    for (const auto& [i, j] : kEdgeCorners) {
      const Edge e = sorted(Edge{v[i], v[j]});
      const auto it = std::lower_bound(edges.begin(), edges.end(), e);
      if (it != edges.end() && *it == e) found[static_cast<std::size_t>(it - edges.begin())] = true;
    }
  }
  return std::find(found.begin(), found.end(), false) == found.end();
}

struct Attempt {
  const char* switches;
  std::uint64_t order;
};

// b0: without TetGen's Hilbert sort, which crashed on one in a hundred small sectors (3,000 of
// 3,000 passed without it at the first attempt). Another order of insertion may mend what is left;
// a wider tolerance takes more points for coplanar than they are.
constexpr std::array kAttempts{Attempt{"pYYMcQb0", 0}, Attempt{"pYYMcQb0", 1}, Attempt{"pYYMcQ", 2},
                               Attempt{"pYYMcQb0T1e-6", 3}};

Result<SectorMesh> checked_mesh(const TriangleComplex& complex, Tetrahedralization&& result) {
  SectorMesh mesh;
  mesh.points = std::move(result.points);
  mesh.tets = std::move(result.tets);
  SYMCELL_TRY(link(complex.triangles, mesh));
  if (!has_edges(mesh, complex.edges)) return failed("an edge was lost");
  return mesh;
}

}  // namespace

Result<SectorMesh> make_sector_mesh(const Sector& sector,
                                    const CutSection& section,
                                    ExecutionContext& context) {
  const TriangleComplex complex = make_complex(sector, section);
  Failure last = failed("not tried");
  for (const auto& [switches, order] : kAttempts) {
    TetgenOptions options;
    options.switches = switches;
    options.order = order;
    auto result = run_tetgen(complex, options, context);
    if (result) {
      auto mesh = checked_mesh(complex, std::move(*result));
      if (mesh) {
        mesh->sector_faces = static_cast<std::int32_t>(sector.faces.size());
        mesh->section_faces = static_cast<std::int32_t>(section.faces.size());
        return mesh;
      }
      last = error_of(mesh);
    } else {
      last = error_of(result);
    }
    if (last.value().code != ErrorCode::kTetrahedralizationFailed) break;
  }
  return last;
}

}  // namespace symcell::solid::initial
