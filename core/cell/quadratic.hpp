// Mid-side nodes for order 2.
#pragma once

#include <cstdint>
#include <span>

#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

// An edge with its mid-side node elsewhere than half-way.
struct CurvedSide {
  std::int32_t a = 0;  // cell nodes
  std::int32_t b = 0;
  Point3 middle;  // where the cell has it, in the local frame
};

// The same mesh with one mid-side node an edge, at its midpoint or, of a facet with a bulge, in the
// middle of its arc, or where `sides` says, and at all copies; shared between elements, and between the
// bounds as one orbit; those of edges on the axis lie on it.  Triangles and tetrahedra, facets of both.
// Requires: mesh.order == 1; of copies of an edge one at most in `sides`.
// Cost: O(elements log elements).
[[nodiscard]] SymmetryCellMesh elevate_to_quadratic(const SymmetryCellMesh& mesh,
                                                    std::span<const CurvedSide> sides = {});

}  // namespace symcell
