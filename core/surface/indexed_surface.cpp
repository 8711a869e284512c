#include "core/surface/indexed_surface.hpp"

#include <algorithm>
#include <tuple>

namespace symcell {

Box3 bounding_box(std::span<const Point3> points) {
  Box3 box{points.front(), points.front()};
  for (const Point3& p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

double surface_area(const IndexedSurface& surface) {
  double twice = 0;
  for (const Triangle& t : surface.triangles) twice += length(area_normal(surface, t));
  return twice / 2;
}

double enclosed_volume(const IndexedSurface& surface, Point3 origin) {
  double sixfold = 0;
  for (const Triangle& t : surface.triangles) {
    const Point3 a = surface.points[t[0]] - origin;
    const Point3 b = surface.points[t[1]] - origin;
    const Point3 c = surface.points[t[2]] - origin;
    sixfold += dot(a, cross(b, c));
  }
  return sixfold / 6;
}

std::vector<EdgeUse> sorted_edge_uses(std::span<const Triangle> triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = triangles[t][i];
      const std::int32_t b = triangles[t][(i + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& x, const EdgeUse& y) {
    return std::tie(x.low, x.high, x.triangle) < std::tie(y.low, y.high, y.triangle);
  });
  return uses;
}

}  // namespace symcell
