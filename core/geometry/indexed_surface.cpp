#include "core/geometry/indexed_surface.hpp"

#include <algorithm>
#include <numeric>
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
  // By lower end first: those of one are few and sorted at once.
  std::vector<std::size_t> end_of(1, 0);
  const auto visit = [triangles](const auto& use) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = triangles[t][i];
        const std::int32_t b = triangles[t][(i + 1) % 3];
        use(EdgeUse{std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), a < b});
      }
    }
  };
  visit([&](const EdgeUse& use) {
    const auto low = static_cast<std::size_t>(use.low);
    if (end_of.size() <= low) end_of.resize(low + 1, 0);
    ++end_of[low];
  });
  std::exclusive_scan(end_of.begin(), end_of.end(), end_of.begin(), std::size_t{0});
  std::vector<EdgeUse> uses(3 * triangles.size());
  visit([&](const EdgeUse& use) { uses[end_of[static_cast<std::size_t>(use.low)]++] = use; });
  std::size_t begin = 0;
  for (const std::size_t end : end_of) {
    std::sort(uses.begin() + static_cast<std::ptrdiff_t>(begin),
              uses.begin() + static_cast<std::ptrdiff_t>(end),
              [](const EdgeUse& x, const EdgeUse& y) {
                return std::tie(x.high, x.triangle) < std::tie(y.high, y.triangle);
              });
    begin = end;
  }
  return uses;
}

}  // namespace symcell
