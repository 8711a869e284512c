// From a wedge of a surface whose two cuts are nearly images of each other to a quotient surface.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/sector/wedge_cut.hpp"
#include "core/solid/surface/quotient_surface.hpp"

namespace symcell::solid {

struct GluedSurface {
  QuotientSurface surface;
  double largest_move = 0;  // of a vertex of the higher cut onto the lower one's image
};

// The curves of the two cuts are paired and their vertices matched; the common curve has all
// vertices of both and the shape of the lower one.  `reach`: curves farther apart than this are
// none; vertices nearer than `merge` along the curve are one.
// Errors: kInternal (the cuts do not match, pinches, edges on the axis: try another angle), limits.
[[nodiscard]] Result<GluedSurface> glue_cuts(WedgePatch patch,
                                             double reach,
                                             double merge,
                                             ExecutionContext& context);

}  // namespace symcell::solid
