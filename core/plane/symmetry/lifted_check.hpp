// The last check of a symmetrised PSLG: all copies lifted to floating point still make a planar
// graph with the faces that were meant, and each face that needs a seed has one inside.
#pragma once

#include "core/base/execution_context.hpp"
#include "core/plane/symmetry/orbit_closure.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

// All copies of all vertices, segments and seeds, relative to the centre; copy k of segment s is
// segment s * fold + k.
[[nodiscard]] Pslg lift_pslg(const SymmetricPslg& symmetric);

// Checks the lifted copies exactly. Keeps one seed a face: of the input's where one lies in its
// face still, else a new one, for vertices may have moved past a seed near them.
// Requires: closed.pslg.holes and regions are the input's, relative to the centre.
// Errors: kNotSymmetric, kCancelled, kTimeLimit.  Cost: O(N log N).
[[nodiscard]] Result<void> check_and_seed(ClosedOrbits& closed, ExecutionContext& context);

}  // namespace symcell::plane
