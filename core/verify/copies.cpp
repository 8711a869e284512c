// The full mesh as copies of the cell: restored from the cell's pairs, or compared with it.
#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "core/verify/symmetry.hpp"

namespace symcell::internal {
namespace {

// Even permutations of an element's corners: the orders in which a copy may name them.
using CornerOrder = std::array<std::size_t, 4>;
constexpr std::array<CornerOrder, 3> kTriangleOrders{{{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}}};
constexpr std::array<CornerOrder, 12> kTetrahedronOrders{{{0, 1, 2, 3},
                                                          {1, 2, 0, 3},
                                                          {2, 0, 1, 3},
                                                          {0, 2, 3, 1},
                                                          {0, 3, 1, 2},
                                                          {1, 0, 3, 2},
                                                          {1, 3, 2, 0},
                                                          {2, 1, 3, 0},
                                                          {2, 3, 0, 1},
                                                          {3, 0, 2, 1},
                                                          {3, 1, 0, 2},
                                                          {3, 2, 1, 0}}};

// Axes of one direction written twice differ by rounding only.
constexpr double kSameDirection = 1e-12;

class CopyChecker {
 public:
  CopyChecker(const MeshData& cell, const MeshData& full, const Turns& turns, double tolerance)
      : cell_(cell), full_(full), turns_(turns), tolerance_(tolerance) {}

  bool run(bool every_region, Checks& checks) {
    const std::string unlike = difference();
    if (!unlike.empty()) return checks.add("full.copies", false, unlike);
    const std::size_t elements = cell_.element_count();
    std::vector<char> seen(full_.element_count(), 0);
    for (std::size_t e = 0; e < seen.size(); ++e) look_at(e, elements, seen, every_region);
    check_full_pairs(checks);
    regions_.report(checks, "full.regions");
    return copies_.report(checks, "full.copies", "worst off by " + shown(worst_));
  }

 private:
  // What the two meshes as a whole differ by.
  [[nodiscard]] std::string difference() const {
    const std::size_t wanted =
        cell_.element_count() * static_cast<std::size_t>(std::max(cell_.fold, 1));
    if (full_.fold != cell_.fold || full_.order != cell_.order ||
        full_.dimension != cell_.dimension ||
        distance(full_.axis_origin, cell_.axis_origin) > tolerance_ ||
        distance(full_.axis_direction, cell_.axis_direction) > kSameDirection) {
      return "dimension, fold, order or axis differ from the cell's";
    }
    if (full_.element_count() != wanted) {
      return std::to_string(full_.element_count()) + " elements, expected " +
             std::to_string(wanted);
    }
    if (full_.sectors.size() != wanted || full_.cell_elements.size() != wanted) {
      return "sector or cell_element is missing";
    }
    return {};
  }

  void look_at(std::size_t e, std::size_t elements, std::vector<char>& seen, bool every_region) {
    const auto s = static_cast<std::size_t>(full_.sectors[e]);
    const auto c = static_cast<std::size_t>(full_.cell_elements[e]);
    const auto name = [&] { return "element " + std::to_string(e); };
    if (s >= static_cast<std::size_t>(cell_.fold) || c >= elements) {
      copies_.note([&] { return name() + " has a sector or cell element that does not exist"; });
      return;
    }
    if (seen[s * elements + c]++ != 0) {
      copies_.note([&] { return name() + " is the second copy of a cell element in one sector"; });
    }
    const double off = copy_error(e);
    worst_ = std::max(worst_, off);
    if (!(off <= tolerance_)) {
      copies_.note([&] { return name() + " is off the rotated cell by " + shown(off); });
    }
    if ((every_region || s == 0) && full_.regions[e] != cell_.regions[c]) {
      regions_.note([&] {
        return name() + " has region " + std::to_string(full_.regions[e]) +
               ", its element of the cell " + std::to_string(cell_.regions[c]) +
               (every_region ? " (a model with regions of its own would exempt other sectors)"
                             : "");
      });
    }
  }

  // A full mesh need not have pairs; where it has, they hold.
  void check_full_pairs(Checks& checks) const {
    if (full_.lower_to_higher.empty()) return;
    Flaws flaws;
    for (std::size_t i = 0; i < full_.lower_to_higher.size(); ++i) {
      const std::int32_t j = full_.lower_to_higher[i];
      if (j < 0) continue;
      const bool there = static_cast<std::size_t>(j) < full_.points.size();
      if (there && distance(turns_.rotated(full_.points[i], 1),
                            full_.points[static_cast<std::size_t>(j)]) <= tolerance_) {
        continue;
      }
      flaws.note([&] { return "node " + std::to_string(i) + " is off its pair"; });
    }
    flaws.report(checks, "full.pairs");
  }

  // Where the nodes of an element stand if its corners are named in another order.
  [[nodiscard]] std::array<std::size_t, 10> node_order(const CornerOrder& corners) const {
    std::array<std::size_t, 10> order{};
    const auto count = static_cast<std::size_t>(cell_.dimension) + 1;
    std::copy_n(corners.begin(), count, order.begin());
    const auto edges = internal::edge_corners(cell_.dimension);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const std::size_t a = corners[edges[i][0]], b = corners[edges[i][1]];
      for (std::size_t j = 0; j < edges.size(); ++j) {
        const bool same =
            (edges[j][0] == a && edges[j][1] == b) || (edges[j][0] == b && edges[j][1] == a);
        if (same) order[count + i] = count + j;
      }
    }
    return order;
  }

  [[nodiscard]] double copy_error(std::size_t e) const {
    const auto k = static_cast<std::size_t>(cell_.nodes_per_element);
    const auto source = static_cast<std::size_t>(full_.cell_elements[e]);
    std::array<Point3, 10> wanted;
    for (std::size_t i = 0; i < k; ++i) {
      const auto node = static_cast<std::size_t>(cell_.elements[source * k + i]);
      wanted[i] = turns_.rotated(cell_.points[node], full_.sectors[e]);
    }
    const std::span<const CornerOrder> orders =
        cell_.dimension == 2 ? std::span<const CornerOrder>(kTriangleOrders) : kTetrahedronOrders;
    double best = kFar;
    for (const CornerOrder& corners : orders) {
      const auto order = node_order(corners);
      double worst = 0;
      for (std::size_t i = 0; i < k; ++i) {
        const auto node = static_cast<std::size_t>(full_.elements[e * k + order[i]]);
        worst = std::max(worst, distance(wanted[i], full_.points[node]));
      }
      best = std::min(best, worst);
      if (best <= tolerance_) break;
    }
    return best;
  }

  const MeshData& cell_;
  const MeshData& full_;
  const Turns& turns_;
  double tolerance_;
  double worst_ = 0;
  Flaws copies_, regions_;
};

}  // namespace

MeshData restore(const MeshData& cell, const Turns& turns) {
  const std::size_t nodes = cell.points.size();
  const auto n = static_cast<std::size_t>(cell.fold);
  std::vector<std::size_t> parent(nodes * n);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t i = 0; i < nodes; ++i) {
    if (cell.lower_to_higher[i] < 0) continue;
    const auto j = static_cast<std::size_t>(cell.lower_to_higher[i]);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t a = root((k + 1) % n * nodes + i);
      const std::size_t b = root(k * nodes + j);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  MeshData full = cell;
  full.lower_to_higher.clear();
  full.points.clear();
  full.elements.clear();
  full.regions.clear();
  std::vector<std::int32_t> id(parent.size(), -1);
  for (std::size_t v = 0; v < parent.size(); ++v) {
    const std::size_t r = root(v);
    if (r == v) {
      id[v] = static_cast<std::int32_t>(full.points.size());
      full.points.push_back(
          turns.rotated(cell.points[v % nodes], static_cast<std::int32_t>(v / nodes)));
    } else {
      id[v] = id[r];  // the root is the smallest of its class
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (const std::int32_t node : cell.elements) {
      full.elements.push_back(id[k * nodes + static_cast<std::size_t>(node)]);
    }
    for (std::size_t e = 0; e < cell.element_count(); ++e) {
      full.regions.push_back(cell.regions[e]);
      full.sectors.push_back(static_cast<std::int32_t>(k));
      full.cell_elements.push_back(static_cast<std::int32_t>(e));
    }
  }
  return full;
}

bool check_copies(const MeshData& cell,
                  const MeshData& full,
                  const Turns& turns,
                  double tolerance,
                  bool every_region,
                  Checks& checks) {
  return CopyChecker(cell, full, turns, tolerance).run(every_region, checks);
}

}  // namespace symcell::internal
