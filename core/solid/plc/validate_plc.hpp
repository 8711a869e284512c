// What a PLC must hold before anything is computed from it.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/plc.hpp"
#include "core/solid/plc/plc_cells.hpp"
#include "core/solid/plc/plc_complex.hpp"

namespace symcell::solid {

struct ValidPlc {
  PlcComplex complex;
  PlcCells cells;
};

// Checks, in this order: size, finite coordinates and seeds, range, indices, zero-length segments,
// duplicate vertices (nearer than resolution_of), facets that are not planar, facets without area,
// polygons that cross in their plane, facets and segments that cross or overlap (exact), that
// something is enclosed, seeds (each in an enclosed cell, none that contradict each other).  The
// first failure is returned with the ids at fault and a JSON pointer.
// A vertex or segment that lies on a facet or segment, to within the rounding of coordinates,
// becomes part of it. Facets that enclose nothing, inside or outside, are allowed.
// Errors: the model codes; limits.  Cost: O(N log N).
[[nodiscard]] Result<ValidPlc> validate_plc(const Plc& plc, ExecutionContext& context);

}  // namespace symcell::solid
