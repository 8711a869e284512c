// The restored full mesh as a stream: n rotated copies of the cell, nodes on the bounds shared.
//
// Memory is O(cell) whatever n is: nothing of the full mesh is ever stored. Node and element ids
// follow from arithmetic, so writers can emit any part in any order:
// - node id of (orbit, k): k * m + rank of the orbit among the m orbits off the axis; the axis
//   orbits follow after all n * m others; so the nodes of sector copies are contiguous;
// - element id of cell element e in sector s: s * E + e; sector s is the cell rotated by 360 s / n.
// Source: [paper] sec. 6.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

class FullMeshView {
 public:
  // Keeps a reference: `cell` must outlive the view.  Cost: O(orbits).
  explicit FullMeshView(const SymmetryCellMesh& cell);

  [[nodiscard]] const SymmetryCellMesh& cell() const { return *cell_; }
  [[nodiscard]] std::int32_t sectors() const { return cell_->fold; }
  [[nodiscard]] std::int64_t node_count() const { return node_count_; }
  [[nodiscard]] std::int64_t element_count() const {
    return static_cast<std::int64_t>(cell_->element_count()) * cell_->fold;
  }

  // Position of a copy of an orbit in model coordinates.
  [[nodiscard]] Point3 position(OrbitVertex v) const;
  // Position of a node of the cell, the same bits as in sector 0 of the full mesh.
  [[nodiscard]] Point3 cell_node_position(std::size_t node) const {
    return position(cell_->nodes[node]);
  }

  // Full node id of cell node `node` as it stands in `sector`.
  [[nodiscard]] std::int64_t node_id(std::size_t node, std::int32_t sector) const {
    const OrbitVertex v = cell_->nodes[node];
    const std::int64_t rank = rank_[static_cast<std::size_t>(v.orbit)];
    if (rank >= off_axis_) return rank_on_axis(rank);
    return static_cast<std::int64_t>(rotations_.add(v.exponent, sector)) * off_axis_ + rank;
  }

  // The orbit copy that full node `id` is.  `id` in [0, node_count()).
  [[nodiscard]] OrbitVertex node(std::int64_t id) const;
  // Marker of the full node `id` (as of the cell node of its orbit; markers are per orbit).
  [[nodiscard]] std::int32_t node_marker(std::int64_t id) const;

  [[nodiscard]] const RotationTable& rotations() const { return rotations_; }

 private:
  [[nodiscard]] std::int64_t rank_on_axis(std::int64_t rank) const {
    return (cell_->fold - 1) * off_axis_ + rank;  // = fold * m + (rank - m)
  }

  const SymmetryCellMesh* cell_;
  RotationTable rotations_;
  std::int64_t off_axis_ = 0;  // m
  std::int64_t node_count_ = 0;
  std::vector<std::int64_t> rank_;  // per orbit; axis orbits rank after the others
  std::vector<std::int32_t> orbit_of_rank_;
  std::vector<std::int32_t> marker_;  // per orbit
};

}  // namespace symcell
