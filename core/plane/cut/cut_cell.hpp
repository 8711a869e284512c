// The final symmetry cell: one representative per orbit of triangles, chosen so that the cell is
// connected and its bounds have the fewest edges.
//
// The quotient of a part round the centre is a ring (or a cone with the centre as apex). Loops in
// it have a holonomy, the exponent that a triangle carries when it is taken once round. At most two
// ends of it have one that is not zero: the boundary loops round the centre, or the centre itself.
// Cutting along any path of edges from one end to the other leaves a piece without holonomy, which
// unrolls into one connected cell; a shortest path gives the fewest symmetry edges there are.
// Source: [paper] sec. 3 (cut by two symmetric shortest paths), here on the refined mesh.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/plane/quotient/quotient_triangulation.hpp"

namespace symcell::plane {

struct CellCut {
  // Per triangle slot: the exponent at which the triangle stands in the cell.
  std::vector<std::int32_t> exponent;
  // Half-edges of the cut with the cell counter-clockwise of them about the centre: the lower
  // bound.
  std::vector<HalfEdge> lower;
};

// One piece per edge-connected component.  Cost: O(E log E).  Errors: kInternal.
[[nodiscard]] Result<CellCut> cut_cell(const QuotientTriangulation& mesh);

}  // namespace symcell::plane
