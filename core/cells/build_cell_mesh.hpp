// From the quotient mesh and its cut to the result that writers and stores take.
#pragma once

#include "core/cells/extract_cell.hpp"
#include "core/cells/symmetry_cell_mesh.hpp"
#include "core/initial/initial_triangulation.hpp"
#include "core/symmetry/symmetric_pslg.hpp"

namespace symcell {

[[nodiscard]] SymmetryCellMesh build_cell_mesh(const InitialTriangulation& triangulation,
                                               const CellCut& cut,
                                               const SymmetricPslg& pslg);

}  // namespace symcell
