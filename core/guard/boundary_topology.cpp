#include "core/guard/boundary_topology.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/base/index.hpp"

namespace symcell {
namespace {

// Classes of orbits (of vertices, of corners) that hang together, with the exponent of each
// relative to its root: a loop that comes back at another exponent joins copies. A class of m
// loops' greatest common divisor with the fold has that many pieces.
class Pieces {
 public:
  Pieces(std::int32_t fold, std::size_t orbits)
      : fold_(fold), parent_(orbits), exponent_(orbits, 0), copies_(orbits, fold) {
    std::iota(parent_.begin(), parent_.end(), std::int32_t{0});
  }

  // Copy 0 of a and copy `exponent` of b are one piece; a vertex on the axis is in all copies.
  void join(std::int32_t a, std::int32_t b, std::int32_t exponent, bool all_copies) {
    const auto [ra, ea] = root(a);
    const auto [rb, eb] = root(b);
    const std::int32_t loop = ea - exponent - eb;  // of rb, seen from ra
    if (ra == rb) {
      copies_[at(ra)] = std::gcd(copies_[at(ra)], loop);
    } else {
      parent_[at(rb)] = ra;
      exponent_[at(rb)] = loop % fold_;
      copies_[at(ra)] = std::gcd(copies_[at(ra)], copies_[at(rb)]);
    }
    if (all_copies) copies_[at(ra)] = 1;
  }

  // Pieces of the class that i is the root of, 0: it is none.
  [[nodiscard]] std::int64_t pieces(std::size_t i) const {
    return parent_[i] == static_cast<std::int32_t>(i) ? copies_[i] : 0;
  }

 private:
  // The root, and the exponent to add to that of an orbit's copy.
  std::pair<std::int32_t, std::int32_t> root(std::int32_t i) {
    std::int32_t top = i, sum = 0;
    while (parent_[at(top)] != top) {
      sum = (sum + exponent_[at(top)]) % fold_;
      top = parent_[at(top)];
    }
    // Whatever was passed hangs from the root now.
    for (std::int32_t rest = sum; parent_[at(i)] != i && i != top;) {
      const std::int32_t next = parent_[at(i)], own = exponent_[at(i)];
      parent_[at(i)] = top;
      exponent_[at(i)] = rest;
      rest = (rest - own) % fold_;
      i = next;
    }
    return {top, sum};
  }

  std::int32_t fold_;
  std::vector<std::int32_t> parent_;
  std::vector<std::int32_t> exponent_;  // to the parent
  std::vector<std::int32_t> copies_;    // of roots: pieces of the class
};

std::int32_t corner_of(const OrbitEdgeUse& use, bool low_end) {
  return 3 * use.triangle + (use.forward == low_end ? use.side : (use.side + 1) % 3);
}

void keep_different(std::vector<std::int32_t>& orbits) {
  std::sort(orbits.begin(), orbits.end());
  orbits.erase(std::unique(orbits.begin(), orbits.end()), orbits.end());
}

}  // namespace

OrbitEdge orbit_edge(std::int32_t fold,
                     std::span<const std::uint8_t> on_axis,
                     OrbitVertex a,
                     OrbitVertex b,
                     bool* swapped) {
  // Of two copies of one orbit the lower is the one from which it is the shorter way.
  const bool swap =
      a.orbit != b.orbit ? a.orbit > b.orbit : 2 * ((b.exponent - a.exponent + fold) % fold) > fold;
  if (swap) std::swap(a, b);
  if (swapped != nullptr) *swapped = swap;
  OrbitEdge edge{a.orbit, b.orbit, 0};
  if (on_axis[at(a.orbit)] == 0 && on_axis[at(b.orbit)] == 0) {
    edge.exponent = (b.exponent - a.exponent + fold) % fold;
  }
  return edge;
}

std::vector<OrbitEdgeUse> sorted_edge_uses(std::int32_t fold,
                                           std::span<const std::uint8_t> on_axis,
                                           std::span<const OrbitTriangle> triangles) {
  const auto use_of = [&](std::size_t t, std::size_t side) {
    OrbitEdgeUse use;
    bool swapped = false;
    use.edge =
        orbit_edge(fold, on_axis, triangles[t][side], triangles[t][(side + 1) % 3], &swapped);
    use.triangle = static_cast<std::int32_t>(t);
    use.side = static_cast<std::int32_t>(side);
    use.forward = !swapped;
    return use;
  };
  const auto each_side = [&](const auto& take) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t side = 0; side < 3; ++side) take(use_of(t, side));
    }
  };
  // By the lower end in one go: few have the same.
  std::vector<std::uint32_t> end(on_axis.size() + 1, 0);
  each_side([&](const OrbitEdgeUse& use) { ++end[at(use.edge.low) + 1]; });
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<OrbitEdgeUse> uses(3 * triangles.size());
  each_side([&](const OrbitEdgeUse& use) { uses[end[at(use.edge.low)]++] = use; });
  for (std::size_t orbit = 0, first = 0; orbit < on_axis.size(); first = end[orbit++]) {
    std::sort(uses.begin() + static_cast<std::ptrdiff_t>(first), uses.begin() + end[orbit],
              [](const OrbitEdgeUse& x, const OrbitEdgeUse& y) {
                return std::tie(x.edge, x.triangle, x.side) < std::tie(y.edge, y.triangle, y.side);
              });
  }
  return uses;
}

BoundaryTopology boundary_topology(std::int32_t fold,
                                   std::span<const std::uint8_t> on_axis,
                                   std::span<const OrbitTriangle> triangles) {
  BoundaryTopology result;
  const std::vector<OrbitEdgeUse> uses = sorted_edge_uses(fold, on_axis, triangles);
  Pieces shells(fold, on_axis.size());
  // Corners, joined over common edges: round a vertex on the axis a fan may close in one copy, or
  // after all of them.
  Pieces fans(fold, 3 * triangles.size());
  std::vector<char> used(on_axis.size(), 0), beside_pinch(on_axis.size(), 0);
  const auto is_axis = [&](std::int32_t orbit) { return fold > 1 && on_axis[at(orbit)] != 0; };
  const auto exponent_at = [&](std::int32_t corner) {
    return triangles[at(corner / 3)][at(corner % 3)].exponent;
  };
  const auto join_fans = [&](const OrbitEdgeUse& x, const OrbitEdgeUse& y, bool by_low) {
    const std::int32_t turn = exponent_at(corner_of(x, by_low)) - exponent_at(corner_of(y, by_low));
    for (const bool low : {true, false}) {
      fans.join(corner_of(x, low), corner_of(y, low), turn, false);
    }
  };
  result.euler = static_cast<std::int64_t>(fold) * static_cast<std::int64_t>(triangles.size());
  for (std::size_t i = 0, next = 0; i < uses.size(); i = next) {
    const OrbitEdge& e = uses[i].edge;
    std::ptrdiff_t forward = 0;
    for (next = i; next < uses.size() && uses[next].edge == e; ++next) {
      forward += uses[next].forward ? 1 : -1;
    }
    const bool low_axis = is_axis(e.low), high_axis = is_axis(e.high);
    // Along the axis all copies of a triangle meet.
    const bool axis = low_axis && high_axis;
    // An edge that half a turn takes onto itself has half as many copies, and triangles of which
    // one stands for two.
    const bool turns = fold > 1 && e.low == e.high && 2 * e.exponent == fold;
    result.euler -= axis ? 1 : turns ? fold / 2 : fold;
    shells.join(e.low, e.high, e.exponent, low_axis || high_axis);
    used[at(e.low)] = used[at(e.high)] = 1;
    if (next - i == 2 && !axis && !turns) {
      join_fans(uses[i], uses[i + 1], !low_axis);
    } else {
      beside_pinch[at(e.low)] = beside_pinch[at(e.high)] = 1;
    }
    if (turns) continue;
    if (forward != 0) ++result.open_edges;
    if (next - i > 2 || (axis && static_cast<std::size_t>(fold) * (next - i) > 2)) {
      ++result.pinched_edges;
      result.touching.insert(result.touching.end(), {e.low, e.high});
    }
  }
  std::vector<std::int64_t> fan_count(on_axis.size(), 0);
  for (std::size_t c = 0; c < 3 * triangles.size(); ++c) {
    fan_count[at(triangles[c / 3][c % 3].orbit)] += fans.pieces(c);
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) continue;
    const auto orbit = static_cast<std::int32_t>(i);
    const std::int64_t copies = is_axis(orbit) ? 1 : fold;
    result.euler += copies;
    result.shells += shells.pieces(i);
    if (fan_count[i] > copies && beside_pinch[i] == 0) result.pinched_vertices.push_back(orbit);
  }
  result.touching.insert(result.touching.end(), result.pinched_vertices.begin(),
                         result.pinched_vertices.end());
  keep_different(result.touching);
  return result;
}

}  // namespace symcell
