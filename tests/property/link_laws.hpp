// The laws of how the elements of a solid's mesh hang together, found from the nodes' numbers and
// places alone: what a crack breaks, whatever it looks like.
//
//   links     elements round every node and edge hang together by faces, in the full mesh where
//             the model does, in the cell wherever they do in the full mesh
//   rim       an edge of the boundary has two faces of it
//   topology  the boundary has as many pieces and handles as the model's
//   hanging   no node lies within a face or edge of the boundary
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/cell/symmetry_cell_mesh.hpp"
#include "tests/support/model_topology.hpp"

namespace symcell {

struct ModelTopology {
  double diameter = 0;
  test::Pinches pinches;
  std::optional<test::BoundaryTopology> boundary;  // nullopt: not known
};

// One line for each law that does not hold, with the first entity at fault.  Requires: a cell of
// tetrahedra.  Cost: O(N log N) for N elements of the full mesh.
[[nodiscard]] std::vector<std::string> broken_link_laws(const SymmetryCellMesh& cell,
                                                        const ModelTopology& model);

}  // namespace symcell
