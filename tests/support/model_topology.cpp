#include "tests/support/model_topology.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace symcell::test {

namespace {

// Of simplices that meet in whole edges and corners.
template <std::size_t N>
BoundaryTopology topology_of(std::span<const std::array<std::int64_t, N>> simplices) {
  std::set<std::pair<std::int64_t, std::int64_t>> edges;
  std::map<std::int64_t, std::int64_t> up;  // per vertex: another of its piece
  for (const auto& s : simplices) {
    for (std::size_t i = 0; i < N; ++i) {
      edges.insert(std::minmax({s[i], s[(i + 1) % N]}));
      up[s[i]] = s[i];
    }
  }
  const auto root = [&](std::int64_t v) {
    while (up[v] != v) v = up[v] = up[up[v]];
    return v;
  };
  for (const auto& [a, b] : edges) up[root(a)] = root(b);
  BoundaryTopology result;
  for (const auto& [v, other] : up) result.pieces += v == other ? 1 : 0;
  const std::size_t faces = N == 3 ? simplices.size() : 0;
  result.euler =
      static_cast<std::int64_t>(up.size() + faces) - static_cast<std::int64_t>(edges.size());
  return result;
}

}  // namespace

BoundaryTopology boundary_topology(std::span<const std::array<std::int64_t, 3>> triangles) {
  return topology_of(triangles);
}

BoundaryTopology boundary_topology(std::span<const std::array<std::int64_t, 2>> segments) {
  return topology_of(segments);
}

BoundaryTopology boundary_topology(const TriangleSurface& surface) {
  std::map<std::array<double, 3>, std::int64_t> index;
  std::vector<std::array<std::int64_t, 3>> triangles;
  for (const auto& t : surface.triangles) {
    auto& triangle = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 p = surface.vertices[static_cast<std::size_t>(t[i])];
      const auto next = static_cast<std::int64_t>(index.size());
      triangle[i] = index.try_emplace({p.x, p.y, p.z}, next).first->second;
    }
  }
  return boundary_topology(triangles);
}

BoundaryTopology boundary_topology(const solid::ValidPlc& valid) {
  const auto meshed = [&](std::int32_t cell) {
    return valid.cells.cells[static_cast<std::size_t>(cell)].meshed;
  };
  std::vector<std::array<std::int64_t, 3>> triangles;
  for (std::size_t f = 0; f < valid.complex.facets.size(); ++f) {
    const auto& all = valid.complex.facets[f].triangles.triangles;
    for (std::size_t t = 0; t < all.size(); ++t) {
      const auto [front, back] = valid.cells.sides[f][t];
      if (meshed(front) != meshed(back)) triangles.push_back({all[t][0], all[t][1], all[t][2]});
    }
  }
  return boundary_topology(triangles);
}

}  // namespace symcell::test
