// What every symmetrised PSLG must hold, found by independent means.
#pragma once

#include "core/model/pslg.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell {

// Adds a failure for each broken invariant of symmetric_pslg.hpp, and if the meshed area differs
// from the input's by more than the error reported can explain.
void expect_symmetric_invariants(const plane::SymmetricPslg& symmetric, const Pslg& input);

}  // namespace symcell
