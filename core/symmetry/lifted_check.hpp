// The last check of a symmetrised PSLG: all copies lifted to floating point still make a planar
// graph with the faces that were meant.
#pragma once

#include "core/base/execution_context.hpp"
#include "core/symmetry/orbit_closure.hpp"
#include "core/symmetry/symmetric_pslg.hpp"

namespace symcell {

// All copies of all vertices, segments and seeds, relative to the centre; vertex (orbit, k) has
// index orbit * fold + k, but the centre, if a vertex, is the last one.
[[nodiscard]] Pslg lift_pslg(const SymmetricPslg& symmetric);

// Errors: kNotSymmetric, kCancelled, kTimeLimit.  Cost: O(N log N).
[[nodiscard]] Result<void> check_lifted(const SymmetricPslg& symmetric,
                                        const ClosedOrbits& closed,
                                        ExecutionContext& context);

}  // namespace symcell
