#include "api/formats/mesh_stream.hpp"

#include <algorithm>

namespace symcell {

MeshStream::MeshStream(const SymmetryCellMesh& cell, MeshPart part)
    : cell_(&cell), part_(part), view_(cell) {
  const auto orbits = static_cast<std::int64_t>(cell.orbit_points.size());
  // nodes = fold * m + (orbits - m) for m orbits off the axis.
  const std::int64_t m = cell.fold == 1 ? orbits : (view_.node_count() - orbits) / (cell.fold - 1);
  off_axis_ = static_cast<std::size_t>(m);
  orbit_of_rank_.reserve(cell.orbit_points.size());
  marker_of_rank_.reserve(cell.orbit_points.size());
  for (std::int64_t r = 0; r < orbits; ++r) {
    const std::int64_t id = r < m ? r : m * cell.fold + (r - m);
    orbit_of_rank_.push_back(view_.node(id).orbit);
    marker_of_rank_.push_back(view_.node_marker(id));
  }
  table_.resize(cell.nodes.size());
}

std::int64_t MeshStream::node_count() const {
  return full() ? view_.node_count() : static_cast<std::int64_t>(cell_->nodes.size());
}

std::int64_t MeshStream::element_count() const {
  return static_cast<std::int64_t>(cell_->element_count()) * sectors();
}

std::int64_t MeshStream::facet_count() const {
  const auto all = static_cast<std::int64_t>(cell_->facet_count());
  if (!full()) return all;
  const auto images = std::ranges::count_if(cell_->boundary_is_higher_image,
                                            [](std::uint8_t image) { return image != 0; });
  return (all - images) * sectors();
}

std::span<const std::int64_t> MeshStream::node_table(std::int32_t sector) {
  for (std::size_t i = 0; i < table_.size(); ++i) {
    table_[i] = full() ? view_.node_id(i, sector) : static_cast<std::int64_t>(i);
  }
  return table_;
}

}  // namespace symcell
