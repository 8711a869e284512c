// The boundary of a mesh as a surface to cut sectors from.
#pragma once

#include "core/geometry/indexed_surface.hpp"
#include "core/solid/quotient/quotient_tetrahedralization.hpp"

namespace symcell::solid {

// All copies, in the local frame; triangles look outwards.  Cost: O(tetrahedra + fold triangles).
[[nodiscard]] IndexedSurface full_boundary(const QuotientTetrahedralization& mesh);

}  // namespace symcell::solid
