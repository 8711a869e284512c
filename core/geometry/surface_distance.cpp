#include "core/geometry/surface_distance.hpp"

#include <algorithm>
#include <array>

#include "core/geometry/spatial_order.hpp"
#include "core/geometry/triangle_tree.hpp"

namespace symcell {
namespace {

bool covers(const IndexedSurface& surface, const std::vector<Point3>& samples, double reach) {
  const TriangleTree tree(surface.points, surface.triangles);
  std::int32_t last = -1;
  return std::all_of(samples.begin(), samples.end(),
                     [&](const Point3& p) { return tree.within(p, reach, last); });
}

}  // namespace

std::vector<Point3> samples_of(const IndexedSurface& surface) {
  std::vector<Point3> samples = surface.points;
  samples.reserve(samples.size() + 5 * surface.triangles.size() / 2);
  for (const Triangle& t : surface.triangles) {
    const std::array<Point3, 3> p = {surface.points[t[0]], surface.points[t[1]],
                                     surface.points[t[2]]};
    samples.push_back((1.0 / 3) * (p[0] + p[1] + p[2]));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (t[i] < t[j]) samples.push_back(0.5 * (p[i] + p[j]));  // from one of two triangles
    }
  }
  sort_along_hilbert_curve(samples);
  return samples;
}

bool are_near(const IndexedSurface& a, const IndexedSurface& b, double reach) {
  return covers(a, samples_of(b), reach) && covers(b, samples_of(a), reach);
}

}  // namespace symcell
