// A closed surface round any triangles, whatever is wrong with them.
#pragma once

#include <span>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

// The alpha wrap of the triangles: closed, oriented, without self-intersections, and outside of them
// by `offset`; gaps narrower than about `alpha` are closed over and concave edges rounded so far.
// `source` of its triangles is -1.
// Requires: at least one triangle; alpha, offset > 0.
// Errors: kSelfIntersection (the library failed), limits.
// Cost: some (area / alpha^2) insertions into a Delaunay triangulation.
// Source: [Portaneri-et-al22], CGAL's alpha wrapping.
[[nodiscard]] Result<IndexedSurface> wrap_surface(const IndexedSurface& surface,
                                                  double alpha,
                                                  double offset,
                                                  ExecutionContext& context);

}  // namespace symcell::solid
