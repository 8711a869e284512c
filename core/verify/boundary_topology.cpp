#include "core/verify/boundary_topology.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace symcell {
namespace {

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

// Classes of orbits that hang together, with the exponent of each relative to its root: a loop that
// comes back at another exponent joins copies. A class of m loops' greatest common divisor with the
// fold has that many pieces.
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

  // Of the classes that `used` orbits belong to.
  [[nodiscard]] std::int64_t count(const std::vector<char>& used) const {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      if (used[i] != 0 && parent_[i] == static_cast<std::int32_t>(i)) sum += copies_[i];
    }
    return sum;
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

// Corners of triangles, joined over common edges.
class Fans {
 public:
  explicit Fans(std::size_t triangles) : parent_(3 * triangles) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    i = root(i);
    j = root(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::size_t> parent_;
};

std::size_t corner_of(const OrbitEdgeUse& use, bool low_end) {
  const auto side = static_cast<std::size_t>(use.side);
  return 3 * at(use.triangle) + (use.forward == low_end ? side : (side + 1) % 3);
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
  std::vector<OrbitEdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t side = 0; side < 3; ++side) {
      OrbitEdgeUse use;
      bool swapped = false;
      use.edge =
          orbit_edge(fold, on_axis, triangles[t][side], triangles[t][(side + 1) % 3], &swapped);
      use.triangle = static_cast<std::int32_t>(t);
      use.side = static_cast<std::int32_t>(side);
      use.forward = !swapped;
      uses.push_back(use);
    }
  }
  std::sort(uses.begin(), uses.end(), [](const OrbitEdgeUse& x, const OrbitEdgeUse& y) {
    return std::tie(x.edge, x.triangle, x.side) < std::tie(y.edge, y.triangle, y.side);
  });
  return uses;
}

BoundaryTopology boundary_topology(std::int32_t fold,
                                   std::span<const std::uint8_t> on_axis,
                                   std::span<const OrbitTriangle> triangles) {
  BoundaryTopology result;
  const std::vector<OrbitEdgeUse> uses = sorted_edge_uses(fold, on_axis, triangles);
  Pieces pieces(fold, on_axis.size());
  Fans fans(triangles.size());
  std::vector<char> used(on_axis.size(), 0), beside_pinch(on_axis.size(), 0);
  const auto is_axis = [&](std::int32_t orbit) { return fold > 1 && on_axis[at(orbit)] != 0; };
  result.euler = static_cast<std::int64_t>(fold) * static_cast<std::int64_t>(triangles.size());
  for (std::size_t i = 0, next = 0; i < uses.size(); i = next) {
    const OrbitEdge& e = uses[i].edge;
    std::ptrdiff_t forward = 0;
    for (next = i; next < uses.size() && uses[next].edge == e; ++next) {
      forward += uses[next].forward ? 1 : -1;
    }
    const bool low_axis = is_axis(e.low), high_axis = is_axis(e.high);
    // An edge that half a turn takes onto itself has half as many copies.
    const bool turns = fold > 1 && e.low == e.high && 2 * e.exponent == fold;
    result.euler -= low_axis && high_axis ? 1 : turns ? fold / 2 : fold;
    pieces.join(e.low, e.high, e.exponent, low_axis || high_axis);
    used[at(e.low)] = used[at(e.high)] = 1;
    // Along the axis, and across it, triangles are not all told: a copy stands for others.
    if (next - i == 2) {
      fans.join(corner_of(uses[i], true), corner_of(uses[i + 1], true));
      fans.join(corner_of(uses[i], false), corner_of(uses[i + 1], false));
    } else {
      beside_pinch[at(e.low)] = beside_pinch[at(e.high)] = 1;
    }
    if ((low_axis && high_axis) || turns) continue;
    if (forward != 0) ++result.open_edges;
    if (next - i > 2) {
      ++result.pinched_edges;
      result.touching.insert(result.touching.end(), {e.low, e.high});
    }
  }
  std::vector<std::int64_t> fan_of(on_axis.size(), -1);
  for (std::size_t c = 0; c < 3 * triangles.size(); ++c) {
    const std::int32_t orbit = triangles[c / 3][c % 3].orbit;
    const auto root = static_cast<std::int64_t>(fans.root(c));
    std::int64_t& first = fan_of[at(orbit)];
    if (first < 0) first = root;
    if (first != root && beside_pinch[at(orbit)] == 0) result.pinched_vertices.push_back(orbit);
  }
  keep_different(result.pinched_vertices);
  result.touching.insert(result.touching.end(), result.pinched_vertices.begin(),
                         result.pinched_vertices.end());
  keep_different(result.touching);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] != 0) result.euler += is_axis(static_cast<std::int32_t>(i)) ? 1 : fold;
  }
  result.shells = pieces.count(used);
  return result;
}

}  // namespace symcell
