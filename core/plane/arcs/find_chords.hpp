// Which segments of a symmetrised PSLG are chords of arcs.
#pragma once

#include "core/model/pslg.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

// Sets `symmetric.bulges`, by where the segments lie: those whose ends stand where the ends of a
// chord of `chorded` do are chords of its arc.
// `tolerance`: distance by which symmetrising may have moved vertices.  Cost: O(N) expected.
void find_chords(const Pslg& chorded, double tolerance, SymmetricPslg& symmetric);

}  // namespace symcell::plane
