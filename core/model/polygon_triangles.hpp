// Polygons of surface files as triangles.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/error.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell {

// Appends the triangles of a polygon to `surface.triangles`, oriented as the polygon is, and
// `face` for each to `surface.source_face`. Convex polygons, and all others that the diagonals of
// one vertex cut well, become fans; others get a constrained Delaunay triangulation in the plane
// nearest to them; what crosses itself becomes a fan all the same, for the checks of the surface to
// find.
// REQUIRES: three indices or more, all of vertices of the surface.
// Errors: kDegenerateFacet (names `face`) if a polygon of more than three corners visits a vertex
// twice.  Cost: O(k log k) for k corners.
[[nodiscard]] Result<void> append_polygon(std::span<const std::int32_t> polygon,
                                          std::int32_t face,
                                          TriangleSurface& surface);

}  // namespace symcell
