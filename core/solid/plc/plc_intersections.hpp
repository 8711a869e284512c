// Facets and segments of a complex that cross or overlap.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/plc/plc_complex.hpp"

namespace symcell::solid {

// Requires: the complex conforms.  Exact.  Errors: kSelfIntersection, naming both entities and a
// place where they meet; limits.  Cost: O(n log n + pairs of boxes that meet).
[[nodiscard]] Result<void> check_intersections(const PlcComplex& complex,
                                               ExecutionContext& context);

}  // namespace symcell::solid
