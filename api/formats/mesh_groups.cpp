#include "api/formats/mesh_groups.hpp"

#include <algorithm>

namespace symcell {

std::string marker_name(const SymmetryCellMesh& cell, std::int32_t marker) {
  const auto known = std::ranges::find(cell.marker_names, marker, &MarkerName::marker);
  return known == cell.marker_names.end() ? "boundary_" + std::to_string(marker) : known->name;
}

std::string region_name(std::int32_t attribute) {
  return "region_" + std::to_string(attribute);
}

MeshGroups::MeshGroups(MeshStream& mesh) : mesh_(mesh) {
  const SymmetryCellMesh& cell = mesh.cell();
  const auto n = static_cast<std::size_t>(cell.fold);
  varied_regions_ = mesh.full() && !cell.sector_regions.empty();
  varied_markers_ = mesh.full() && !cell.sector_boundary_markers.empty();
  regions_ = group_by(cell.element_count() * (varied_regions_ ? n : 1), [&](std::uint32_t i) {
    return varied_regions_ ? cell.sector_regions[i] : cell.regions[i];
  });
  for (std::size_t b = 0; b < cell.facet_count(); ++b) {
    if (mesh.full() && cell.boundary_is_higher_image[b] != 0) continue;
    facets_.push_back(static_cast<std::uint32_t>(b));
  }
  markers_ = group_by(facets_.size() * (varied_markers_ ? n : 1), [&](std::uint32_t i) {
    return varied_markers_ ? cell.sector_boundary_markers[facets_[i / n] * n + i % n]
                           : cell.boundary_markers[facets_[i]];
  });
}

std::int64_t MeshGroups::region_size(std::size_t g) const {
  const auto size = static_cast<std::int64_t>(regions_.members(g).size());
  return varied_regions_ ? size : size * mesh_.sectors();
}

std::int64_t MeshGroups::marker_size(std::size_t g) const {
  const auto size = static_cast<std::int64_t>(markers_.members(g).size());
  return varied_markers_ ? size : size * mesh_.sectors();
}

}  // namespace symcell
