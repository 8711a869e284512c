// The constrained Delaunay triangulation of one planar facet in space, with what lies inside found
// by flooding.
//
// Points are projected along the coordinate axis nearest to the facet's normal, which rounds
// nothing; points a little off the plane do no harm.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

using IndexPair = std::array<std::int32_t, 2>;

struct FacetGraph {
  Point3 normal;                     // any length > 0
  std::vector<IndexPair> segments;   // each once; what they enclose is inside the facet
  std::vector<IndexPair> cuts;       // edges the triangles keep, but which bound nothing
  std::vector<std::int32_t> points;  // further vertices, on no segment
  std::vector<Point3> holes;         // what segments separate from the rest round such a point
};

struct FacetTriangles {
  std::vector<std::array<std::int32_t, 3>> triangles;  // inside; counter-clockwise about the normal
  // Per triangle: its component, where both segments and cuts separate; from 0.
  std::vector<std::int32_t> piece;
  std::int32_t piece_count = 0;
  std::vector<std::uint8_t> segment_sides;  // per segment: 0, 1 or 2 of its sides are inside
  std::vector<std::uint8_t> cut_sides;      // per cut, likewise
  std::vector<std::uint8_t> hole_enclosed;  // per hole: whether segments enclose it
};

// Indices of `graph` are into `points`.  Errors: kSelfIntersection, with the point indices of the
// segment or cut in the way in `elements`, if edges cross or pass through vertices, or vertices
// coincide.  Cost: O(m log m) for m edges.
[[nodiscard]] Result<FacetTriangles> triangulate_facet(std::span<const Point3> points,
                                                       const FacetGraph& graph);

// The point of the plane in which the facet's triangulation sees `p`.
[[nodiscard]] Point2 project_along(Point3 normal, Point3 p);

}  // namespace symcell
