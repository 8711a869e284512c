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
  std::uint64_t number = 0;  // of the nodes: what facets are found by
  bool even = true;          // the nodes run counter-clockwise seen from outside the element
  std::int32_t element = 0;
};

// Sorts; true for an even permutation.
bool sort_nodes(Nodes& nodes, std::int32_t dimension);

// A number that no two facets are expected to share, nor sums of some to be those of others.
[[nodiscard]] std::uint64_t number_of(const Nodes& nodes);

// Numbers of an element's facets, those that are odd negative: of both sides of a facet the sum is 0.
// `v`: the nodes of a triangle, of a tetrahedron.
[[nodiscard]] std::uint64_t signed_sides_2(const std::int32_t* v);
[[nodiscard]] std::uint64_t signed_faces_3(const std::int32_t* v);

[[nodiscard]] std::string name_of(const Nodes& nodes);

[[nodiscard]] Failure broken(const std::string& what);

// A facet between two elements.
struct InnerFacet {
  Nodes nodes;
  std::array<std::int32_t, 2> elements{};
};

// Facet i of element e, opposite its corner i.
[[nodiscard]] ElementFacet element_facet(const SymmetryCellMesh& cell,
                                         std::size_t e,
                                         std::size_t i);

// Facets of elements by their nodes: which have one element and which have two. A table with open
// places, small and much faster than sorting.
class FacetTable {
 public:
  // `most`: different facets.
  FacetTable(const SymmetryCellMesh& cell, std::size_t most);

  // Adds facet i of its element. The other element of the facet, -1: this is the first.
  // Errors: a third element, two on one side, more different facets than were said to come.
  [[nodiscard]] Result<std::int32_t> add(const ElementFacet& facet, std::size_t i);

  // Says that the facet is soon added.
  void prefetch(const ElementFacet& facet) const {
    __builtin_prefetch(&places_[facet.number & (places_.size() - 1)]);
  }

  // Whether a facet of these nodes, ascending, has two elements.
  [[nodiscard]] bool is_inner(const Nodes& sorted) const;

  // Those with one element, sorted by number and nodes.
  [[nodiscard]] std::vector<ElementFacet> outer() const;

 private:
  struct Place {
    std::uint64_t number = 0;
    std::uint32_t facet = 0;  // of the first element: its index times the corners, plus i
    std::uint16_t count = 0;  // elements; 0: an open place
    bool even = true;         // of the first element's facet
  };
  [[nodiscard]] bool holds(const Place& place, std::uint64_t number, const Nodes& nodes) const;
  [[nodiscard]] std::size_t place_of(std::uint64_t number, const Nodes& nodes) const;

  const SymmetryCellMesh& cell_;
  std::uint32_t corners_;      // of an element
  std::size_t left_;           // different facets that may still come
  std::vector<Place> places_;  // a power of two of them
};

// Whether all elements at a node of the cell's surface, in space at an edge of it too, hang
// together by facets. `marked`: the nodes of the surface.  `at_surface`: the elements with one of them,
// ascending.  `inner`: facets with a marked node and two elements.  `pinched`: per orbit; there the full mesh touches itself, and the cell may.
[[nodiscard]] Result<void> check_cell_links(const SymmetryCellMesh& cell,
                                            const std::vector<char>& marked,
                                            const std::vector<std::int32_t>& at_surface,
                                            const std::vector<InnerFacet>& inner,
                                            const std::vector<char>& pinched);

}  // namespace symcell::internal
