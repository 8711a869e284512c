// Vertices of a triangle soup that are one point.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/indexed_surface.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell::solid {

// Equal coordinates become one point (-0 counts as 0), in order of first use. Triangles with two
// equal corners are dropped.  Requires: indices in range, coordinates finite.
[[nodiscard]] IndexedSurface weld_exactly(const TriangleSurface& surface);

// The same for what has been indexed before.
[[nodiscard]] IndexedSurface weld_exactly(const IndexedSurface& surface);

// Clusters of points linked by distances up to `tolerance` become one point, their mean. Dropped
// are triangles that lose an edge by it, and pairs of triangles that then lie on each other with
// opposite orientations.  Cost: O(n log n) while clusters stay small.
[[nodiscard]] IndexedSurface weld_within(const IndexedSurface& surface, double tolerance);

// Drops all but one of triangles with the same corners in the same cyclic order, and both of a pair
// in opposite order.  Returns the places of what was dropped, one of each triangle's corners;
// `cancelled`, if given, gets one triangle of each pair in opposite order.
std::vector<Point3> drop_doubled_triangles(IndexedSurface& surface,
                                           IndexedSurface* cancelled = nullptr);

// Triangles of `cancelled` (over the points of `surface`) go back where a group of neighbours of them
// closes a hole.  Returns how many went back.
std::size_t restore_needed(IndexedSurface& surface, const IndexedSurface& cancelled);

// Points that no triangle uses go; the order stays.
void drop_unused_points(IndexedSurface& surface);

}  // namespace symcell::solid
