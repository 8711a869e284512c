// Figures of a finished cell, taken from its node positions as they are written.
#pragma once

#include "core/cell/statistics.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

// Fills statistics.cell and statistics.full.  Order 2: the corners count.
void measure_cell_2(const SymmetryCellMesh& cell, Statistics& statistics);
// Of a solid; the angles are those of the tetrahedra's faces.  Cost: about 0.2 us a tetrahedron.
void measure_cell_3(const SymmetryCellMesh& cell, Statistics& statistics);

// Peak resident memory of this process in bytes, 0 where the system does not report it.
[[nodiscard]] std::uint64_t peak_memory_bytes();

}  // namespace symcell
