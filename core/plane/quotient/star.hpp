// Walks round a vertex of the quotient, in the frame where the vertex has exponent 0.
#pragma once

#include "core/plane/quotient/quotient_triangulation.hpp"

namespace symcell::plane {

// A triangle at a vertex: corner `i` of triangle `t`, which stands at exponent `e`.
struct StarItem {
  TriangleId t = 0;
  std::uint32_t i = 0;
  std::int32_t e = 0;
};

// The star item of a corner (half-edge 3t + i) in the frame of its vertex.
[[nodiscard]] inline StarItem star_item(const QuotientTriangulation& mesh, HalfEdge corner) {
  const TriangleId t = triangle_of(corner);
  const std::uint32_t i = local_of(corner);
  return {t, i, mesh.subtract(0, mesh.triangle(t).k[i])};
}

// Next triangle counter-clockwise; false at the domain's boundary.
[[nodiscard]] inline bool rotate_ccw(const QuotientTriangulation& mesh, StarItem& item) {
  const Triangle& tri = mesh.triangle(item.t);
  const std::uint32_t j = next3(item.i);  // the edge from the last corner to the vertex
  const HalfEdge g = tri.nb[j];
  if (g == kNoHalfEdge) return false;
  item.e = mesh.add(item.e, tri.off[j]);
  item.t = triangle_of(g);
  item.i = next3(local_of(g));
  return true;
}

[[nodiscard]] inline bool rotate_cw(const QuotientTriangulation& mesh, StarItem& item) {
  const Triangle& tri = mesh.triangle(item.t);
  const std::uint32_t j = prev3(item.i);  // the edge from the vertex to the next corner
  const HalfEdge g = tri.nb[j];
  if (g == kNoHalfEdge) return false;
  item.e = mesh.add(item.e, tri.off[j]);
  item.t = triangle_of(g);
  item.i = prev3(local_of(g));
  return true;
}

// The corner after (which = 1) or before (2) the vertex in a star item's triangle, in the frame.
[[nodiscard]] inline OrbitVertex star_corner(const QuotientTriangulation& mesh,
                                             const StarItem& item,
                                             std::uint32_t which) {
  const Triangle& tri = mesh.triangle(item.t);
  const std::uint32_t c = which == 1 ? next3(item.i) : prev3(item.i);
  return {tri.v[c], mesh.shift(tri.v[c], tri.k[c], item.e)};
}

// Turns back clockwise to the boundary, if there is one. Returns true for an open star.
// The centre's star repeats itself under rotation: it ends after one turn of the quotient.
inline bool to_star_begin(const QuotientTriangulation& mesh, StarItem& item) {
  const StarItem first = item;
  StarItem at = item;
  while (rotate_cw(mesh, at)) {
    if (at.t == first.t && at.i == first.i) {
      item = first;
      return false;
    }
  }
  item = at;
  return true;
}

}  // namespace symcell::plane
