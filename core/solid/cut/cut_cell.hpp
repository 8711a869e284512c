// The final symmetry cell of a solid: one representative per orbit of tetrahedra.
//
// Representatives x(tet) in Z minimise the number of symmetry faces, sum |x_a - x_b - o_ab| over
// the faces of the quotient with exponents lifted to Z: an L-natural-convex function, so steepest
// descent by s-t minimum cuts reaches the global minimum. Then the six rules of [paper] sec. 5.2
// are checked by name and what they find is repaired by moving tetrahedra until the cell is one
// manifold piece per component.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/solid/initial/initial_tetrahedralization.hpp"
#include "core/solid/quotient/quotient_tetrahedralization.hpp"
#include "core/solid/sector/sector_source.hpp"

namespace symcell::solid {

struct CellCut {
  // Per tetrahedron slot: the exponent in [0, n) at which it stands in the cell.
  std::vector<std::int32_t> exponent;
  // Half-faces of the lower bound; behind each is the copy of its neighbour one sector below.
  std::vector<HalfFace> lower;
  std::uint64_t symmetry_faces = 0;  // = lower.size()
};

// Cost: some minimum cuts over the quotient's faces.  Errors: kInternal, limits.
[[nodiscard]] Result<CellCut> cut_cell(const QuotientTetrahedralization& mesh,
                                       ExecutionContext& context);

[[nodiscard]] SymmetryCellMesh build_cell_mesh(const InitialTetrahedralization& solid,
                                               const CellCut& cut,
                                               const Symmetry& symmetry);

}  // namespace symcell::solid
