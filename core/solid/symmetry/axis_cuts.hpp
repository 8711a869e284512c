// Where a PLC meets its symmetry axis.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/symmetry/symmetric_plc.hpp"

namespace symcell::solid {

// Cuts segments that cross the axis (pass it within `tolerance`) there, gives facets pierced by it
// a point there, and facets that contain a piece of it that piece as a segment. Requires: vertices,
// orbits and positions in the local frame are set. Errors: as make_plc_complex.
[[nodiscard]] Result<void> cut_at_axis(double tolerance,
                                       SymmetricPlc& plc,
                                       ExecutionContext& context);

}  // namespace symcell::solid
