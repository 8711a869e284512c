#include "core/solid/surface/t_junctions.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace symcell::solid {
namespace {

// More open edges than this are holes, not junctions.
constexpr std::size_t kMostOpenEdges = 4000;

struct OpenSide {
  std::int32_t a, b;
  std::int32_t triangle;
};

}  // namespace

std::size_t split_at_t_junctions(IndexedSurface& surface, double tolerance) {
  std::vector<OpenSide> open;
  std::vector<std::int32_t> ends;
  const std::vector<EdgeUse> uses = sorted_edge_uses(surface.triangles);
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 1) return;
    open.push_back({uses[begin].low, uses[begin].high, uses[begin].triangle});
    ends.insert(ends.end(), {uses[begin].low, uses[begin].high});
  });
  if (open.size() > kMostOpenEdges) return 0;
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<bool> taken(surface.triangles.size(), false);
  std::size_t joined = 0;
  for (const OpenSide& side : open) {
    // A triangle with two such edges is cut along one of them only; a second call does the other.
    if (taken[side.triangle]) continue;
    const Point3 a = surface.points[side.a], d = surface.points[side.b] - a;
    const double squared = squared_length(d);
    std::vector<std::pair<double, std::int32_t>> inner;
    for (const std::int32_t v : ends) {
      if (v == side.a || v == side.b) continue;
      const Point3 p = surface.points[v] - a;
      const double t = dot(p, d) / squared;
      if (!(t > 0 && t < 1) || squared_length(p - t * d) > tolerance * tolerance) continue;
      inner.emplace_back(t, v);
    }
    if (inner.empty()) continue;
    std::sort(inner.begin(), inner.end());
    taken[side.triangle] = true;
    joined += inner.size();
    const Triangle old = surface.triangles[side.triangle];
    std::size_t i = 0;
    while (old[i] == side.a || old[i] == side.b) ++i;
    const std::int32_t apex = old[i];
    const bool forward = old[(i + 1) % 3] == side.a;
    std::vector<std::int32_t> chain{side.a};
    for (const auto& [t, v] : inner) chain.push_back(v);
    chain.push_back(side.b);
    if (!forward) std::reverse(chain.begin(), chain.end());
    surface.triangles[side.triangle] = {apex, chain[0], chain[1]};
    for (std::size_t k = 1; k + 1 < chain.size(); ++k) {
      surface.triangles.push_back({apex, chain[k], chain[k + 1]});
      surface.source.push_back(surface.source[side.triangle]);
    }
  }
  return joined;
}

}  // namespace symcell::solid
