#include "api/formats/decks/bound_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "api/formats/mesh_groups.hpp"
#include "core/base/index.hpp"

namespace symcell::internal {
namespace {

// `nodes`: all of one orbit off the axis, two at least.
void add_copies(const SymmetryCellMesh& cell,
                std::span<const std::uint32_t> nodes,
                BoundNodes& bounds) {
  const auto exponent = [&](std::uint32_t node) { return cell.nodes[node].exponent; };
  // The one whose next copy is not in the cell; of a full turn, the first.
  const auto follows = [&](std::uint32_t a, std::uint32_t b) {
    return exponent(b) == (exponent(a) + 1) % cell.fold;
  };
  const auto free = std::ranges::find_if(nodes, [&](std::uint32_t a) {
    return std::ranges::none_of(nodes, [&](std::uint32_t b) { return follows(a, b); });
  });
  // n = 2: each is the other's next copy, and the lower one is marked.
  const auto unmarked =
      std::ranges::find_if(nodes, [&](std::uint32_t a) { return cell.lower_to_higher[a] < 0; });
  const std::uint32_t independent = free != nodes.end()       ? *free
                                    : unmarked != nodes.end() ? *unmarked
                                                              : nodes.front();
  for (const std::uint32_t node : nodes) {
    if (node == independent) continue;
    std::int32_t turn = exponent(node) - exponent(independent);
    if (turn < 0) turn += cell.fold;
    bounds.copies.push_back(
        {static_cast<std::int32_t>(node), static_cast<std::int32_t>(independent), turn});
    bounds.dependent[node] = 1;
  }
  const bool pair = nodes.size() == 2 && bounds.copies.back().exponent == cell.fold - 1;
  if (!pair && bounds.beyond_pairs < 0) {
    bounds.beyond_pairs = static_cast<std::int32_t>(nodes.front());
  }
}

// Places in (r, z), by squares as wide as the separation.
class Places {
 public:
  explicit Places(double separation) : separation_(separation) {}

  // The first group that has nothing near; the place is then one of it.
  std::size_t group_of(double r, double z) {
    const auto i = static_cast<std::int64_t>(std::floor(r / separation_));
    const auto j = static_cast<std::int64_t>(std::floor(z / separation_));
    std::vector<std::size_t> near;
    for (std::int64_t di = -1; di <= 1; ++di) {
      for (std::int64_t dj = -1; dj <= 1; ++dj) {
        const auto square = squares_.find({i + di, j + dj});
        if (square == squares_.end()) continue;
        near.insert(near.end(), square->second.begin(), square->second.end());
      }
    }
    std::size_t group = 0;
    while (std::ranges::find(near, group) != near.end()) ++group;
    squares_[{i, j}].push_back(group);
    return group;
  }

 private:
  double separation_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::size_t>> squares_;
};

}  // namespace

BoundNodes bound_nodes(const SymmetryCellMesh& cell) {
  BoundNodes bounds;
  bounds.dependent.assign(cell.nodes.size(), 0);
  if (cell.fold == 1) return bounds;
  const LabelGroups orbits =
      group_by(cell.nodes.size(), [&](std::uint32_t i) { return cell.nodes[i].orbit; });
  for (std::size_t g = 0; g < orbits.count(); ++g) {
    const auto nodes = orbits.members(g);
    if (cell.on_axis[at(orbits.labels[g])] != 0) {
      for (const std::uint32_t node : nodes) {
        bounds.axis.push_back(static_cast<std::int32_t>(node));
        bounds.dependent[node] = 1;
      }
    } else if (nodes.size() > 1) {
      add_copies(cell, nodes, bounds);
    }
  }
  std::ranges::sort(bounds.copies, {}, &NodeCopy::dependent);
  std::ranges::sort(bounds.axis);
  return bounds;
}

std::vector<std::vector<NodePair>> distinct_groups(const SymmetryCellMesh& cell,
                                                   const BoundNodes& bounds,
                                                   const std::vector<std::uint8_t>& left_out,
                                                   double separation) {
  std::vector<std::vector<NodePair>> groups;
  Places places(separation);
  const auto add = [&](NodePair pair) {
    const Point3& p = cell.orbit_points[at(cell.nodes[at(pair.lower)].orbit)];
    const std::size_t group = places.group_of(std::hypot(p.x, p.y), p.z);
    if (group >= groups.size()) groups.resize(group + 1);
    groups[group].push_back(pair);
  };
  for (const NodeCopy& copy : bounds.copies) add({copy.dependent, copy.independent});
  for (const std::int32_t node : bounds.axis) {
    if (left_out[at(node)] == 0) add({node, node});
  }
  return groups;
}

}  // namespace symcell::internal
