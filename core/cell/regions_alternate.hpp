// Whether the region attributes of a cell change from sector to sector as north and south poles do.
#pragma once

#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

// True if the attributes of every second sector are alike and those of the sectors between come of
// them by a map that changes some attributes, and by which it comes back: {1 -> 2, 2 -> 1, 3 -> 3}.
// Cost: O(elements n).
[[nodiscard]] bool regions_alternate(const SymmetryCellMesh& cell);

}  // namespace symcell
