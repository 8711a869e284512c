// Cells that have another copy of some elements: still one of each orbit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell::test {

// The chosen elements are taken `exponent` sectors further. Nodes and pairs follow; the boundary
// and the bounds are left out, as VTU files have none.
[[nodiscard]] SymmetryCellMesh with_elements_moved(const SymmetryCellMesh& cell,
                                                   std::int32_t exponent,
                                                   const std::function<bool(std::size_t)>& chosen);

}  // namespace symcell::test
