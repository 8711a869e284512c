// A finished mesh with its figures.
#pragma once

#include "core/cell/statistics.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

struct MeshOutcome {
  SymmetryCellMesh mesh;
  Statistics statistics;
};

}  // namespace symcell
