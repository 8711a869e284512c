// Bodies that touch, given with rounding.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

// Where n copies of a body touch another one, rounding has some of them overlap it, some touch it and some
// stay off: united copy by copy, they would not be copies any more.  So corners of a body where it touches a
// triangle of another, within `reach`, and lies on its outer side, are put `reach` below the triangle's
// plane: then all copies overlap by the same.
// Returns the places of the corners moved.  None: no body touches another, or all that touch do so
// exactly, or too many triangles are near others; the surface is as it was.
// A body that is inside out is taken for a hollow: it is not moved, and bodies that do not have it in
// them may touch its wall; an open surface has no bodies.
// Errors: limits.
// Cost: O(n log n + pairs of triangles within reach).
[[nodiscard]] Result<std::vector<Point3>> deepen_contacts(IndexedSurface& surface,
                                                          double reach,
                                                          ExecutionContext& context);

}  // namespace symcell::solid
