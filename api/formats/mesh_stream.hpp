// The cell or the full mesh as streams of nodes, elements and facets in file order, so that each
// writer is written once. Memory is O(cell): a table of node ids a sector, renewed for each.
//
// Ids: in the cell as the cell has them; in the full mesh as FullMeshView numbers them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "api/formats/mesh_writer.hpp"
#include "core/cell/full_mesh.hpp"

namespace symcell {

class MeshStream {
 public:
  static constexpr std::size_t kMostNodes = 10;  // of an element

  // Keeps a reference: `cell` must outlive the stream.
  MeshStream(const SymmetryCellMesh& cell, MeshPart part);

  [[nodiscard]] const SymmetryCellMesh& cell() const { return *cell_; }
  [[nodiscard]] const FullMeshView& view() const { return view_; }
  [[nodiscard]] bool full() const { return part_ == MeshPart::kFull; }
  [[nodiscard]] std::int32_t sectors() const { return full() ? cell_->fold : 1; }
  [[nodiscard]] std::int64_t node_count() const;
  [[nodiscard]] std::int64_t element_count() const;
  [[nodiscard]] std::int64_t facet_count() const;  // as each_facet visits
  [[nodiscard]] std::size_t nodes_per_element() const {
    return static_cast<std::size_t>(cell_->nodes_per_element);
  }
  [[nodiscard]] std::size_t nodes_per_facet() const {
    return static_cast<std::size_t>(cell_->nodes_per_facet);
  }

  // f(Point3 position, std::int32_t marker)
  template <class F>
  void each_node(F f) const;
  // f(std::int32_t marker)
  template <class F>
  void each_node_marker(F f) const;
  // f(OrbitVertex copy)
  template <class F>
  void each_node_copy(F f) const;
  // f(std::span<const std::int64_t> nodes, std::size_t cell_element, std::int32_t sector)
  template <class F>
  void each_element(F f);
  // f(std::size_t cell_element, std::int32_t sector): for what needs no nodes
  template <class F>
  void each_element_index(F f) const;
  // f(std::span<const std::int64_t> nodes, std::int32_t marker); in the full mesh each facet once
  template <class F>
  void each_facet(F f);

  // f(std::span<const std::int64_t> nodes, std::size_t cell_facet, std::int32_t sector): the same ones
  template <class F>
  void each_facet_index(F f);

  // Asked before each sector: true ends all loops (the receiver is gone).
  void stop_when(std::function<bool()> stopped) { stopped_ = std::move(stopped); }

  [[nodiscard]] bool stopped() const { return stopped_(); }

  // The nodes of one sector: table[i] is the id of cell node i there.
  [[nodiscard]] std::span<const std::int64_t> node_table(std::int32_t sector);

 private:
  const SymmetryCellMesh* cell_;
  MeshPart part_;
  FullMeshView view_;
  std::vector<std::int32_t> orbit_of_rank_;  // off-axis orbits, then those on the axis
  std::vector<std::int32_t> marker_of_rank_;
  std::size_t off_axis_ = 0;
  std::vector<std::int64_t> table_;
  std::function<bool()> stopped_ = [] { return false; };
};

template <class F>
void MeshStream::each_node(F f) const {
  if (!full()) {
    for (std::size_t i = 0; i < cell_->nodes.size(); ++i) {
      f(view_.cell_node_position(i), cell_->node_markers[i]);
    }
    return;
  }
  for (std::int32_t k = 0; k < cell_->fold && !stopped_(); ++k) {
    for (std::size_t r = 0; r < off_axis_; ++r) {
      f(view_.position({orbit_of_rank_[r], k}), marker_of_rank_[r]);
    }
  }
  for (std::size_t r = off_axis_; r < orbit_of_rank_.size(); ++r) {
    f(view_.position({orbit_of_rank_[r], 0}), marker_of_rank_[r]);
  }
}

template <class F>
void MeshStream::each_node_copy(F f) const {
  if (!full()) {
    for (const OrbitVertex& v : cell_->nodes) f(v);
    return;
  }
  for (std::int32_t k = 0; k < cell_->fold && !stopped_(); ++k) {
    for (std::size_t r = 0; r < off_axis_; ++r) f(OrbitVertex{orbit_of_rank_[r], k});
  }
  for (std::size_t r = off_axis_; r < orbit_of_rank_.size(); ++r) {
    f(OrbitVertex{orbit_of_rank_[r], 0});
  }
}

template <class F>
void MeshStream::each_node_marker(F f) const {
  if (!full()) {
    for (const std::int32_t marker : cell_->node_markers) f(marker);
    return;
  }
  for (std::int32_t k = 0; k < cell_->fold && !stopped_(); ++k) {
    for (std::size_t r = 0; r < off_axis_; ++r) f(marker_of_rank_[r]);
  }
  for (std::size_t r = off_axis_; r < marker_of_rank_.size(); ++r) f(marker_of_rank_[r]);
}

template <class F>
void MeshStream::each_element(F f) {
  const std::size_t corners = nodes_per_element();
  const std::size_t elements = cell_->element_count();
  std::array<std::int64_t, kMostNodes> ids{};
  for (std::int32_t s = 0; s < sectors() && !stopped_(); ++s) {
    const auto table = node_table(s);
    const std::int32_t* at = cell_->elements.data();
    for (std::size_t e = 0; e < elements; ++e) {
      for (std::size_t i = 0; i < corners; ++i) ids[i] = table[static_cast<std::size_t>(*at++)];
      f(std::span<const std::int64_t>(ids.data(), corners), e, s);
    }
  }
}

template <class F>
void MeshStream::each_element_index(F f) const {
  const std::size_t elements = cell_->element_count();
  for (std::int32_t s = 0; s < sectors() && !stopped_(); ++s) {
    for (std::size_t e = 0; e < elements; ++e) f(e, s);
  }
}

template <class F>
void MeshStream::each_facet(F f) {
  each_facet_index([&](std::span<const std::int64_t> nodes, std::size_t b, std::int32_t s) {
    f(nodes, cell_->boundary_marker(b, s));
  });
}

template <class F>
void MeshStream::each_facet_index(F f) {
  const std::size_t corners = nodes_per_facet();
  std::array<std::int64_t, kMostNodes> ids{};
  for (std::int32_t s = 0; s < sectors() && !stopped_(); ++s) {
    const auto table = node_table(s);
    for (std::size_t b = 0; b < cell_->facet_count(); ++b) {
      if (full() && cell_->boundary_is_higher_image[b] != 0) continue;
      for (std::size_t i = 0; i < corners; ++i) {
        ids[i] = table[static_cast<std::size_t>(cell_->boundary[b * corners + i])];
      }
      f(std::span<const std::int64_t>(ids.data(), corners), b, s);
    }
  }
}

}  // namespace symcell
