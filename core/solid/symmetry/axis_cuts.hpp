// Where a PLC meets its symmetry axis.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/symmetry/symmetric_plc.hpp"

namespace symcell::solid {

// Cuts segments that cross the axis there, gives facets pierced by it a point there, and facets that
// contain a piece of it that piece as a segment. All these are their own images: what met the axis
// between its ends and was not would cross its image there. So `image`, of the complex as it is, tells
// them, and no tolerance takes what only passes near the axis for them.
// Requires: vertices, orbits and positions in the local frame are set. Errors: as make_plc_complex.
[[nodiscard]] Result<void> cut_at_axis(const ComplexImage& image,
                                       SymmetricPlc& plc,
                                       ExecutionContext& context);

}  // namespace symcell::solid
