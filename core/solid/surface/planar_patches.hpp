// Flat parts of a surface made exactly flat.
//
// CAD faces that are planar come as triangles whose corners are rounded to single precision. A
// patch is a connected set of triangles within a small distance of one plane; its vertices are
// moved onto the plane, or onto the line or point where their planes meet. A vertex where that
// cannot be (too many planes) drops out of the smaller patches with its triangles.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/surface/quotient_surface.hpp"

namespace symcell::solid {

struct FlatnessTolerances {
  double noise = 0;  // of coordinates: every patch may deviate so much
  double most = 0;   // large patches may deviate up to this
};

// Fills planes, patch and frame of the surface and moves its vertices.
// Errors: kInternal (not closed), limits.  Cost: O(n log n).
[[nodiscard]] Result<void> flatten_planar_patches(QuotientSurface& surface,
                                                  const FlatnessTolerances& tolerances,
                                                  ExecutionContext& context);

// Takes triangles out of patches in whose planes they do not lie within rounding.
void drop_bent_triangles(QuotientSurface& surface);

}  // namespace symcell::solid
