// The boundary of a solid as triangles, as STL, OFF, PLY and OBJ give it. A shape's tessellation is
// as a rule not symmetric though the shape is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {

// As read: nothing is welded, oriented or checked. STL has three vertices of its own a triangle;
// vertex and triangle indices are those of the file (polygons of OFF, PLY and OBJ are cut into
// fans, `source_face` then names the polygon).
struct TriangleSurface {
  std::vector<Point3> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> source_face;  // per triangle; empty: the triangle's own index
  // Parts that the file names, and which of them each triangle belongs to; empty: it names none, or one.
  std::vector<std::string> group_names;
  std::vector<std::int32_t> groups;
};

// More than these are refused (kTooLarge): three indices a triangle stay in 32 bits.
inline constexpr std::size_t kMaxSurfaceTriangles = 100'000'000;

}  // namespace symcell
