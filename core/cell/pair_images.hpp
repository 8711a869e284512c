// Pairs of nodes that no facet of the bounds names.
#pragma once

#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

// Where a model touches itself, nodes of the cell can be images of each other without a facet of
// the bounds: sets lower_to_higher of those off the axis that have none.
void pair_beyond_bounds(SymmetryCellMesh& cell);

}  // namespace symcell
