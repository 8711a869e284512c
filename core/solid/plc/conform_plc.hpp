// Makes a complex conform: what touches a segment or facet becomes part of it.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/plc/plc_complex.hpp"

namespace symcell::solid {

// Cuts segments at points that lie on them (within the resolution of the coordinates), gives facets
// the points inside them and the segments that run in them. Afterwards segments and facets meet in
// common points and segments only, unless they cross.
// Errors: kSelfIntersection, naming both facets, where what runs in a facet crosses its segments;
// limits.  Cost: O(N log N).
[[nodiscard]] Result<void> conform(PlcComplex& complex, ExecutionContext& context);

}  // namespace symcell::solid
