// Whether quadratic triangles with curved sides are still images of a triangle.
#pragma once

#include <cstddef>
#include <vector>

#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

// Elements of a planar mesh of order 2 whose Jacobian is not surely positive throughout: its six
// Bezier coefficients are not all above zero.  Cost: O(elements).
[[nodiscard]] std::vector<std::size_t> folded_elements(const SymmetryCellMesh& mesh);

}  // namespace symcell
