#include "core/solid/surface/mass_properties.hpp"

#include <algorithm>
#include <cmath>

namespace symcell::solid {
namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;
constexpr int kMostSweeps = 60;  // Jacobi converges in less than ten

// Eigenvalues on the diagonal of `m`, eigenvectors in the columns of the result.
Matrix3 diagonalise(Matrix3& m) {
  Matrix3 v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    const double off = std::abs(m[0][1]) + std::abs(m[0][2]) + std::abs(m[1][2]);
    const double on = std::abs(m[0][0]) + std::abs(m[1][1]) + std::abs(m[2][2]);
    if (off <= 1e-17 * on) break;  // below rounding
    for (std::size_t p = 0; p < 2; ++p) {
      for (std::size_t q = p + 1; q < 3; ++q) {
        if (m[p][q] == 0) continue;
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::hypot(theta, 1));
        const double c = 1 / std::hypot(t, 1), s = t * c;
        for (std::size_t k = 0; k < 3; ++k) {
          const double a = m[k][p], b = m[k][q];
          m[k][p] = c * a - s * b;
          m[k][q] = s * a + c * b;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const double a = m[p][k], b = m[q][k];
          m[p][k] = c * a - s * b;
          m[q][k] = s * a + c * b;
          const double x = v[k][p], y = v[k][q];
          v[k][p] = c * x - s * y;
          v[k][q] = s * x + c * y;
        }
      }
    }
  }
  return v;
}

}  // namespace

// Tetrahedra from a point near the surface to its triangles; each adds exact moments.
MassProperties mass_properties(const IndexedSurface& surface) {
  const Box3 box = bounding_box(surface.points);
  const Point3 origin = 0.5 * (box.low + box.high);
  double sixfold = 0;
  Point3 first;
  Matrix3 second{};
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
  const Matrix3 v = diagonalise(second);
  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return second[i][i] < second[j][j]; });
  for (std::size_t i = 0; i < 3; ++i) {
    result.moments[i] = second[order[i]][order[i]];
    result.directions[i] = {v[0][order[i]], v[1][order[i]], v[2][order[i]]};
  }
  return result;
}

}  // namespace symcell::solid
