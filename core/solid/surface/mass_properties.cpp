#include "core/solid/surface/mass_properties.hpp"

#include <array>

#include "core/geometry/symmetric_eigen.hpp"

namespace symcell::solid {

// Tetrahedra from a point near the surface to its triangles; each adds exact moments.
MassProperties mass_properties(const IndexedSurface& surface) {
  const Box3 box = bounding_box(surface.points);
  const Point3 origin = 0.5 * (box.low + box.high);
  double sixfold = 0;
  Point3 first;
  std::array<std::array<double, 3>, 3> second{};
  for (const Triangle& t : surface.triangles) {
    const Point3 a = surface.points[t[0]] - origin;
    const Point3 b = surface.points[t[1]] - origin;
    const Point3 c = surface.points[t[2]] - origin;
    const double d = dot(a, cross(b, c));
    const Point3 sum = a + b + c;
    sixfold += d;
    first = first + (d / 24) * sum;
    const std::array<std::array<double, 3>, 4> p{
        {{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}, {sum.x, sum.y, sum.z}}};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        double products = 0;
        for (const auto& q : p) products += q[i] * q[j];
        second[i][j] += d / 120 * products;
      }
    }
  }
  MassProperties result;
  result.volume = sixfold / 6;
  const Point3 mean = (1 / result.volume) * first;
  result.centroid = origin + mean;
  const std::array<double, 3> g{mean.x, mean.y, mean.z};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) second[i][j] = second[i][j] / result.volume - g[i] * g[j];
  }
  const SymmetricEigen eigen = symmetric_eigen(
      {second[0][0], second[0][1], second[0][2], second[1][1], second[1][2], second[2][2]});
  result.moments = eigen.values;
  result.directions = eigen.vectors;
  return result;
}

}  // namespace symcell::solid
