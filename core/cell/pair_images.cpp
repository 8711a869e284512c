#include "core/cell/pair_images.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "core/base/index.hpp"

namespace symcell {
namespace {

// `nodes`: those of one orbit, ascending.
void pair_within(SymmetryCellMesh& cell, std::span<const std::int32_t> nodes) {
  for (const std::int32_t node : nodes) {
    if (cell.lower_to_higher[at(node)] >= 0) continue;
    const std::int32_t next = (cell.nodes[at(node)].exponent + 1) % cell.fold;
    const auto image = std::ranges::find_if(
        nodes, [&](std::int32_t i) { return cell.nodes[at(i)].exponent == next; });
    if (image == nodes.end()) continue;
    // n = 2: each is the other's image, only one of them is marked.
    if (cell.fold == 2 && cell.lower_to_higher[at(*image)] >= 0) continue;
    cell.lower_to_higher[at(node)] = *image;
  }
}

}  // namespace

void pair_beyond_bounds(SymmetryCellMesh& cell) {
  if (cell.fold == 1) return;
  std::vector<std::int32_t> count(cell.orbit_points.size(), 0);
  for (const OrbitVertex& node : cell.nodes) ++count[at(node.orbit)];
  std::vector<std::int32_t> several;
  for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
    const std::int32_t orbit = cell.nodes[i].orbit;
    if (count[at(orbit)] > 1 && cell.on_axis[at(orbit)] == 0) {
      several.push_back(static_cast<std::int32_t>(i));
    }
  }
  const auto orbit = [&](std::int32_t i) { return cell.nodes[at(i)].orbit; };
  std::ranges::stable_sort(several, {}, orbit);
  for (auto i = several.begin(), next = i; i != several.end(); i = next) {
    while (next != several.end() && orbit(*next) == orbit(*i)) ++next;
    pair_within(cell, {i, next});
  }
}

}  // namespace symcell
