// Facets of elements as check_cell looks at them. Internal to guard/.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell::internal {

using Nodes = std::array<std::int32_t, 3>;  // of a facet, ascending; of an edge the third is -1

struct ElementFacet {
  Nodes nodes;
  std::uint64_t number = 0;  // of the nodes: what facets are sorted by
  bool even = true;          // the nodes run counter-clockwise seen from outside the element
  std::int32_t element = 0;
};

// Sorts; true for an even permutation.
bool sort_nodes(Nodes& nodes, std::int32_t dimension);

// A number that no two facets are expected to share, nor sums of some to be those of others.
[[nodiscard]] std::uint64_t number_of(const Nodes& nodes);

[[nodiscard]] std::string name_of(const Nodes& nodes);

[[nodiscard]] Failure broken(const std::string& what);

// Whether all elements at a node of the cell's surface, in space at an edge of it too, hang
// together by facets. `marked`: the nodes of the surface.  `facets`: of elements, with a marked
// node, those of the same nodes together.  `inner`: indices of the first of two such.  `pinched`:
// per orbit; there the full mesh touches itself, and the cell may.
[[nodiscard]] Result<void> check_cell_links(const SymmetryCellMesh& cell,
                                            const std::vector<char>& marked,
                                            const std::vector<ElementFacet>& facets,
                                            const std::vector<std::size_t>& inner,
                                            const std::vector<char>& pinched);

}  // namespace symcell::internal
