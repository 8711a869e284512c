// The bounds of a cell as solvers take them: which nodes are copies of which, and how the pairs part
// into groups that a solver cannot mix up.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cell/full_mesh.hpp"

namespace symcell::internal {

// Node `dependent` is node `independent` turned by exponent * 360/n degrees.
struct NodeCopy {
  std::int32_t dependent = 0;
  std::int32_t independent = 0;
  std::int32_t exponent = 0;  // 1 ... n - 1
};

struct BoundNodes {
  // Off the axis: of every orbit with several nodes in the cell all but one. Of two neighbours the
  // one on the lower bound depends.
  std::vector<NodeCopy> copies;
  std::vector<std::int32_t> axis;       // nodes on the axis
  std::vector<std::uint8_t> dependent;  // per node: its displacements follow from others
  // Not -1: a node that solvers with pairs alone cannot express, since the cell has a third copy of
  // it, or one that is not turned by one sector.
  std::int32_t beyond_pairs = -1;

  // Whether sectors hang together at all.
  [[nodiscard]] bool empty() const { return copies.empty() && axis.empty(); }
};

// Fold 1: empty.  Cost: O(nodes).
[[nodiscard]] BoundNodes bound_nodes(const SymmetryCellMesh& cell);

struct NodePair {
  std::int32_t lower = 0;
  std::int32_t higher = 0;  // the same node on the axis
};

// Pairs in groups in which no two lie within `separation` of each other in (r, z), input units: a
// solver that looks for a node's image by (r, z), as CalculiX does, finds the right one. Copies come
// first, then the nodes on the axis but those that `left_out` marks.
// Requires: bounds.beyond_pairs < 0.  Cost: O(pairs log pairs).
[[nodiscard]] std::vector<std::vector<NodePair>> distinct_groups(
    const SymmetryCellMesh& cell,
    const BoundNodes& bounds,
    const std::vector<std::uint8_t>& left_out,
    double separation);

}  // namespace symcell::internal
