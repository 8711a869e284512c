// Planar patches that are no planes of the shape but strips of a curved part.
#pragma once

#include "core/base/error.hpp"
#include "core/solid/surface/quotient_surface.hpp"

namespace symcell::solid {

// A patch that goes smoothly on into its neighbours along most of its boundary and is so narrow
// that a circle through it would leave it by less than `most` is given up: its triangles are in no
// patch. Errors: kInternal (not closed).
[[nodiscard]] Result<void> dissolve_narrow_patches(QuotientSurface& surface, double most);

// The same for patches with a corner so sharp that no good tetrahedra fit into it, and for those
// hardly wider than `most`.
[[nodiscard]] Result<void> dissolve_sharp_patches(QuotientSurface& surface, double most);

}  // namespace symcell::solid
