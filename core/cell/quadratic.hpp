// Mid-side nodes for order 2.
#pragma once

#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

// The same mesh with one mid-side node an edge, at its midpoint or, of a facet with a bulge, in the
// middle of its arc; shared between elements, and between the bounds as one orbit; those of edges on
// the axis lie on it.  Triangles and
// tetrahedra, facets of both.  Requires: mesh.order == 1.  Cost: O(elements log elements).
[[nodiscard]] SymmetryCellMesh elevate_to_quadratic(const SymmetryCellMesh& mesh);

}  // namespace symcell
