// Fewer and better shaped triangles for the same surface, within a given distance of it.
//
// Tessellations of curved parts have long thin triangles, and a cut adds slivers; a tetrahedral
// mesh must resolve every one of them. First edges are collapsed, shortest first, where the
// triangles that remain are good or no worse than before. What is flat then becomes exactly flat:
// such strips are facets with square corners, whatever their triangles. In what is left thin
// triangles are halved, edges flipped and vertices moved along the surface; at last vertices are
// fitted so that the surface runs through the middle of what it stands for, which keeps the volume.
// Planar patches stay exactly planar, creases and the cut's curves stay edges and lose vertices
// only where they hardly turn; what is done at the cut is done at both its images, since they are
// one.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/surface/planar_patches.hpp"
#include "core/solid/surface/quotient_surface.hpp"

namespace symcell::solid {

// `most`: largest distance between the old and the new surface, both ways; where narrow corners at
// the cut are opened, twice that.
// Requires: planar patches were found. Narrow ones that stand for a curved part are given up.
// Errors: kInternal (not closed), limits.  Cost: O(n log n).
[[nodiscard]] Result<void> improve_surface(QuotientSurface& surface,
                                           double most,
                                           const FlatnessTolerances& flatness,
                                           ExecutionContext& context);

}  // namespace symcell::solid
