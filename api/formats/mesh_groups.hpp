// The groups of a mesh file: elements by region attribute, facets by marker, under the names that
// every format gives them.
//
// Where labels differ between sectors (ignore_markers) a group of the full mesh holds other things
// in every sector; of a cell the labels are those of sector 0. Memory is O(cell), or O(cell * n)
// where labels differ, as the cell itself then has it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "api/formats/mesh_stream.hpp"

namespace symcell {

// Positions in a sequence of things, grouped by a label; ascending labels, order kept in a group.
struct LabelGroups {
  std::vector<std::int32_t> labels;
  std::vector<std::uint32_t> order;
  std::vector<std::size_t> first;  // of group g in `order`; one more at the end

  [[nodiscard]] std::size_t count() const { return labels.size(); }
  [[nodiscard]] std::span<const std::uint32_t> members(std::size_t g) const {
    return std::span(order).subspan(first[g], first[g + 1] - first[g]);
  }
};

template <class F>
LabelGroups group_by(std::size_t count, F label) {
  LabelGroups groups;
  groups.order.resize(count);
  for (std::size_t i = 0; i < count; ++i) groups.order[i] = static_cast<std::uint32_t>(i);
  std::ranges::stable_sort(groups.order, {}, label);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t value = label(groups.order[i]);
    if (!groups.labels.empty() && groups.labels.back() == value) continue;
    groups.labels.push_back(value);
    groups.first.push_back(i);
  }
  groups.first.push_back(count);
  return groups;
}

// "bore", as the model names the marker, else "boundary_3".
[[nodiscard]] std::string marker_name(const SymmetryCellMesh& cell, std::int32_t marker);
[[nodiscard]] std::string region_name(std::int32_t attribute);  // "region_7"

class MeshGroups {
 public:
  // Keeps a reference: `mesh` must outlive the groups.
  explicit MeshGroups(MeshStream& mesh);

  // Ascending attributes, ascending markers.
  [[nodiscard]] const std::vector<std::int32_t>& regions() const { return regions_.labels; }
  [[nodiscard]] const std::vector<std::int32_t>& markers() const { return markers_.labels; }

  // Elements and facets of a group in the file.
  [[nodiscard]] std::int64_t region_size(std::size_t g) const;
  [[nodiscard]] std::int64_t marker_size(std::size_t g) const;

  // Whether a marker's facets differ between the sectors of the file.
  [[nodiscard]] bool varied_markers() const { return varied_markers_; }

  // f(std::size_t cell_facet), without sectors.  Requires: !varied_markers().
  template <class F>
  void each_cell_facet(std::size_t g, F f) const {
    for (const std::uint32_t i : markers_.members(g)) f(std::size_t{facets_[i]});
  }

  // f(std::span<const std::int64_t> nodes, std::size_t cell_element, std::int32_t sector)
  template <class F>
  void each_element(std::size_t g, F f) {
    each(
        regions_, g, varied_regions_, mesh_.cell().elements, mesh_.nodes_per_element(),
        [](std::uint32_t i) { return std::size_t{i}; }, f);
  }
  // f(std::span<const std::int64_t> nodes, std::size_t cell_facet, std::int32_t sector)
  template <class F>
  void each_facet(std::size_t g, F f) {
    each(
        markers_, g, varied_markers_, mesh_.cell().boundary, mesh_.nodes_per_facet(),
        [this](std::uint32_t i) { return std::size_t{facets_[i]}; }, f);
  }

 private:
  template <class Index, class F>
  void each(const LabelGroups& groups,
            std::size_t g,
            bool varied,
            const std::vector<std::int32_t>& nodes,
            std::size_t corners,
            Index index,
            F f) {
    const auto members = groups.members(g);
    const auto sectors = static_cast<std::uint32_t>(mesh_.sectors());
    std::array<std::int64_t, MeshStream::kMostNodes> ids{};
    for (std::uint32_t s = 0; s < sectors && !mesh_.stopped(); ++s) {
      const auto table = mesh_.node_table(static_cast<std::int32_t>(s));
      for (const std::uint32_t member : members) {
        // Members of varied groups are (thing, sector) pairs with the sector running fastest.
        if (varied && member % sectors != s) continue;
        const std::size_t i = index(varied ? member / sectors : member);
        for (std::size_t c = 0; c < corners; ++c) {
          ids[c] = table[static_cast<std::size_t>(nodes[i * corners + c])];
        }
        f(std::span<const std::int64_t>(ids.data(), corners), i, static_cast<std::int32_t>(s));
      }
    }
  }

  MeshStream& mesh_;
  bool varied_regions_ = false;
  bool varied_markers_ = false;
  LabelGroups regions_;                // of elements, or (element, sector) pairs
  std::vector<std::uint32_t> facets_;  // boundary facets that are written
  LabelGroups markers_;                // of positions in facets_, or (position, sector) pairs
};

}  // namespace symcell
