// Triangles over shared points, and their sums.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {

using Triangle = std::array<std::int32_t, 3>;  // point indices

struct IndexedSurface {
  std::vector<Point3> points;
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> source;  // per triangle: the face of the file it came from
};

struct Box3 {
  Point3 low;
  Point3 high;
  [[nodiscard]] double diagonal() const { return distance(low, high); }
  // The largest coordinate.
  [[nodiscard]] double magnitude() const {
    return std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x),
                     std::abs(high.y), std::abs(high.z)});
  }
  [[nodiscard]] bool encloses(const Box3& other) const {
    return low.x <= other.low.x && low.y <= other.low.y && low.z <= other.low.z &&
           high.x >= other.high.x && high.y >= other.high.y && high.z >= other.high.z;
  }
};

// Requires: at least one point.
[[nodiscard]] Box3 bounding_box(std::span<const Point3> points);

// Twice the area times the unit normal; counter-clockwise triangles look towards it.
[[nodiscard]] inline Point3 area_normal(Point3 a, Point3 b, Point3 c) {
  return cross(b - a, c - a);
}
[[nodiscard]] inline Point3 area_normal(const IndexedSurface& s, const Triangle& t) {
  return area_normal(s.points[t[0]], s.points[t[1]], s.points[t[2]]);
}

[[nodiscard]] double surface_area(const IndexedSurface& surface);
// By the divergence theorem, relative to `origin` (near the model, for accuracy).
[[nodiscard]] double enclosed_volume(const IndexedSurface& surface, Point3 origin);

// Undirected edges of a surface, sorted; the triangles at an edge stand together.
struct EdgeUse {
  std::int32_t low = 0;  // point indices, low < high
  std::int32_t high = 0;
  std::int32_t triangle = 0;
  bool forward = false;  // the triangle runs from low to high
};
[[nodiscard]] std::vector<EdgeUse> sorted_edge_uses(std::span<const Triangle> triangles);

// Calls visit(begin, end) for each undirected edge.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> uses, const Visit& visit) {
  for (std::size_t begin = 0; begin < uses.size();) {
    std::size_t end = begin + 1;
    while (end < uses.size() && uses[end].low == uses[begin].low &&
           uses[end].high == uses[begin].high) {
      ++end;
    }
    visit(begin, end);
    begin = end;
  }
}

}  // namespace symcell
