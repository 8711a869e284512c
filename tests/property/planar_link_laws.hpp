// The laws of how the triangles of a mesh hang together, found from the nodes' numbers and places
// alone; of solids: link_laws.hpp.
//
//   links     triangles round every node hang together by edges, in the full mesh where the model
//             does, in the cell wherever they do in the full mesh
//   rim       a node of the boundary has two edges of it
//   topology  the boundary has as many pieces, vertices less edges as the model's
//   hanging   no node lies within an edge of the boundary
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/cell/symmetry_cell_mesh.hpp"
#include "tests/support/model_topology.hpp"

namespace symcell {

struct PlanarTopology {
  double diameter = 0;
  std::vector<Point2> pinches;  // where the model touches itself in a vertex
  std::optional<test::BoundaryTopology> boundary;
};

// One line for each law that does not hold, with the first entity at fault.  Requires: a conforming
// cell of triangles.
[[nodiscard]] std::vector<std::string> broken_planar_link_laws(const SymmetryCellMesh& cell,
                                                               const PlanarTopology& model);

}  // namespace symcell
