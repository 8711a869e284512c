// Groups under the names that decks can have, and facets as sides of elements.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/mesh_groups.hpp"

namespace symcell::internal {

// Behind a group's name: its nodes that depend on no others.
inline constexpr const char* kSupportEnding = "_support";

// Letters, digits and underscores, the first a letter, at most `longest` bytes; no two alike but for
// the case of letters, none one of `reserved`, also with kSupportEnding.
struct DeckNames {
  std::vector<std::string> markers;  // as groups.markers()
  std::vector<std::string> regions;  // as groups.regions()
};

[[nodiscard]] DeckNames deck_names(const SymmetryCellMesh& cell,
                                   const MeshGroups& groups,
                                   std::size_t longest,
                                   std::span<const std::string_view> reserved);

// One number above 0 a label, each its own where it is one, else the smallest that is free.
[[nodiscard]] std::vector<std::int32_t> positive_numbers(const std::vector<std::int32_t>& labels);

// The position in groups.markers() of what the user calls `group`: a marker's number, its name in
// the model or its name in the deck.  Errors: kBadOption, which lists the groups.
[[nodiscard]] Result<std::size_t> find_marker_group(const SymmetryCellMesh& cell,
                                                    const MeshGroups& groups,
                                                    const DeckNames& names,
                                                    std::string_view group);

// The nodes on a marker's facets in the file, each once.  f(std::int64_t node)
// Memory: O(cell), or the nodes themselves where markers differ between sectors.
void each_marker_node(MeshStream& mesh,
                      MeshGroups& groups,
                      std::size_t g,
                      const std::function<void(std::int64_t)>& f);

// Of a facet the first element of the cell that has it, and which of the element's sides it is, from
// 0, as Abaqus counts them: of a triangle 01, 12, 20; of a tetrahedron 012, 031, 132, 230.
struct ElementSide {
  std::uint32_t element = 0;
  std::uint8_t side = 0;
  bool inner = false;  // there is material on both sides, that of a neighbouring sector included
};

// Per facet of cell.boundary.  Errors: kInternal (a facet of no element).
// Cost: O(E log E) for E elements.
[[nodiscard]] Result<std::vector<ElementSide>> facet_sides(const SymmetryCellMesh& cell);

}  // namespace symcell::internal
