// Whether quadratic elements with curved sides are still images of a triangle or tetrahedron.
#pragma once

#include <cstddef>
#include <vector>

#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

// Elements of a planar mesh of order 2 whose Jacobian is not surely positive throughout: its six
// Bezier coefficients are not all above zero.  Cost: O(elements).
[[nodiscard]] std::vector<std::size_t> folded_elements(const SymmetryCellMesh& mesh);

// Tetrahedra of order 2 whose Jacobian is not surely above `least` of six volumes of their corners
// throughout: of its twenty Bezier coefficients one is not.  Cost: O(elements).
[[nodiscard]] std::vector<std::size_t> folded_tetrahedra(const SymmetryCellMesh& mesh,
                                                         double least);

}  // namespace symcell
