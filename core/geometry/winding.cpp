#include "core/geometry/winding.hpp"

#include <cmath>
#include <numbers>

namespace symcell {

double solid_angle(const IndexedSurface& surface, std::int32_t triangle, Point3 p) {
  const Triangle& v = surface.triangles[triangle];
  const Point3 a = surface.points[v[0]] - p;
  const Point3 b = surface.points[v[1]] - p;
  const Point3 c = surface.points[v[2]] - p;
  const double la = length(a), lb = length(b), lc = length(c);
  const double denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return 2 * std::atan2(dot(a, cross(b, c)), denominator);
}

double winding_number(const IndexedSurface& surface, Point3 p) {
  double sum = 0;
  const auto count = static_cast<std::int32_t>(surface.triangles.size());
  for (std::int32_t t = 0; t < count; ++t) sum += solid_angle(surface, t, p);
  return sum / (4 * std::numbers::pi);
}

double winding_number(const IndexedSurface& surface,
                      std::span<const std::int32_t> triangles,
                      Point3 p) {
  double sum = 0;
  for (const std::int32_t t : triangles) sum += solid_angle(surface, t, p);
  return sum / (4 * std::numbers::pi);
}

}  // namespace symcell
