// From the quotient mesh and its cut to the result that writers and stores take.
#pragma once

#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/plane/cut/cut_cell.hpp"
#include "core/plane/initial/initial_triangulation.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

[[nodiscard]] SymmetryCellMesh build_cell_mesh(const InitialTriangulation& triangulation,
                                               const CellCut& cut,
                                               const SymmetricPslg& pslg);

}  // namespace symcell::plane
