// What MSH 4.1 and 2.2 share: element types, the order of nodes, and the tags of groups.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "api/formats/byte_writer.hpp"
#include "api/formats/mesh_groups.hpp"

namespace symcell::internal {

struct GmshTypes {
  int facet;
  int element;
};

[[nodiscard]] GmshTypes gmsh_types(const SymmetryCellMesh& cell);

// Gmsh's tetrahedron of 10 nodes has the last two mid-side nodes the other way round than VTK's.
inline constexpr std::array<std::size_t, 10> kGmshTetrahedron10{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

// `i`: position in Gmsh's order.  Result: position in ours.
[[nodiscard]] constexpr std::size_t gmsh_node(std::size_t nodes, std::size_t i) {
  return nodes == kGmshTetrahedron10.size() ? kGmshTetrahedron10[i] : i;
}

// One tag a group, unique over dimensions, since programs that look at the tag alone (Netgen, GetFEM)
// mix up what shares it. Markers above 0 are their own tags, and so are attributes above 0 that no
// marker has; what is left gets the smallest numbers that are free.
struct GmshTags {
  std::int32_t lower = 0;  // bounds; 0: the file has none
  std::int32_t higher = 0;
  std::vector<std::int32_t> markers;  // as groups.markers()
  std::vector<std::int32_t> regions;  // as groups.regions()
};

[[nodiscard]] GmshTags gmsh_tags(const MeshGroups& groups, bool bounds);

// The section $PhysicalNames: the bounds, if they have tags, markers and regions.
void write_physical_names(const SymmetryCellMesh& cell,
                          const MeshGroups& groups,
                          const GmshTags& tags,
                          ByteWriter& out);

}  // namespace symcell::internal
