#include "api/formats/gmsh_tags.hpp"

#include <algorithm>
#include <set>
#include <string>

namespace symcell::internal {

GmshTypes gmsh_types(const SymmetryCellMesh& cell) {
  if (cell.dimension == 2) return cell.order == 1 ? GmshTypes{1, 2} : GmshTypes{8, 9};
  return cell.order == 1 ? GmshTypes{2, 4} : GmshTypes{9, 11};
}

GmshTags gmsh_tags(const MeshGroups& groups, bool bounds) {
  std::set<std::int32_t> taken;
  GmshTags tags{0, 0, groups.markers(), groups.regions()};
  for (std::vector<std::int32_t>* list : {&tags.markers, &tags.regions}) {
    for (std::int32_t& tag : *list) {
      if (tag <= 0 || !taken.insert(tag).second) tag = 0;
    }
  }
  std::int32_t next = 1;
  const auto free_tag = [&] {
    while (!taken.insert(next).second) ++next;
    return next;
  };
  if (bounds) {
    tags.lower = free_tag();
    tags.higher = free_tag();
  }
  for (std::vector<std::int32_t>* list : {&tags.markers, &tags.regions}) {
    for (std::int32_t& tag : *list) {
      if (tag == 0) tag = free_tag();
    }
  }
  return tags;
}

namespace {

// Names are in quotes and hold none.
void write_name(std::int32_t dimension, std::int32_t tag, std::string name, ByteWriter& out) {
  std::ranges::replace(name, '"', '\'');
  out.integer(dimension);
  out.character(' ');
  out.integer(tag);
  out.text(" \"");
  out.text(name);
  out.text("\"\n");
}

}  // namespace

void write_physical_names(const SymmetryCellMesh& cell,
                          const MeshGroups& groups,
                          const GmshTags& tags,
                          ByteWriter& out) {
  const std::int32_t d = cell.dimension;
  const bool bounds = tags.lower != 0;
  out.text("$PhysicalNames\n");
  out.integer(
      static_cast<std::int64_t>(tags.regions.size() + tags.markers.size() + (bounds ? 2 : 0)));
  out.character('\n');
  if (bounds) {
    write_name(d - 1, tags.lower, "lower_bound", out);
    write_name(d - 1, tags.higher, "higher_bound", out);
  }
  for (std::size_t g = 0; g < tags.markers.size(); ++g) {
    write_name(d - 1, tags.markers[g], marker_name(cell, groups.markers()[g]), out);
  }
  for (std::size_t g = 0; g < tags.regions.size(); ++g) {
    write_name(d, tags.regions[g], region_name(groups.regions()[g]), out);
  }
  out.text("$EndPhysicalNames\n");
}

}  // namespace symcell::internal
