#include "api/formats/gmsh_tags.hpp"

#include <algorithm>
#include <set>

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

}  // namespace symcell::internal
