#include "core/geometry/quadratic_tet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/tet_measures.hpp"

namespace symcell {
namespace {

QuadraticTet straight(Point3 a, Point3 b, Point3 c, Point3 d) {
  return {a,
          b,
          c,
          d,
          0.5 * (a + b),
          0.5 * (b + c),
          0.5 * (c + a),
          0.5 * (a + d),
          0.5 * (b + d),
          0.5 * (c + d)};
}

TEST(QuadraticTet, StraightOnesHaveOneJacobian) {
  const Point3 a{0.1, 0, 0}, b{2, 0.3, 0}, c{0.2, 1.5, 0.1}, d{0.3, 0.4, 1.7};
  const auto coefficients = jacobian_coefficients(straight(a, b, c, d));
  const double expected = six_volumes(a, b, c, d);
  for (const double j : coefficients) EXPECT_NEAR(j, expected, 1e-12);
  EXPECT_NEAR(volume_of(coefficients), expected / 6, 1e-13);
}

// The face on x + y + z = 1 pushed out in the middle of one edge: a parabola above the edge.
TEST(QuadraticTet, VolumeOfABulge) {
  QuadraticTet t = straight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const double h = 0.05;
  t[5] = t[5] + Point3{h, h, 0};
  // By the divergence theorem, or 4 h times the mean of the shape function's gradient: checked with a
  // rule of many points.
  const auto coefficients = jacobian_coefficients(t);
  double sum = 0;
  constexpr int kSteps = 40;
  int count = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j + i < kSteps; ++j) {
      for (int k = 0; k + j + i < kSteps; ++k) {
        // Degree 3 Bernstein polynomials at the middle of a small cell.
        const double x = (i + 0.25) / kSteps, y = (j + 0.25) / kSteps, z = (k + 0.25) / kSteps;
        const double w[4] = {1 - x - y - z, x, y, z};
        double value = 0;
        std::size_t n = 0;
        for (int p = 0; p < 4; ++p) {
          for (int q = p; q < 4; ++q) {
            for (int r = q; r < 4; ++r) {
              const double ways = p == q && q == r ? 1 : p == q || q == r ? 3 : 6;
              value += ways * coefficients[n++] * w[p] * w[q] * w[r];
            }
          }
        }
        sum += value;
        ++count;
      }
    }
  }
  EXPECT_NEAR(sum / count / 6, volume_of(coefficients), 2e-3 / 6);
  EXPECT_GT(volume_of(coefficients), 1.0 / 6);
}

TEST(QuadraticTet, AFoldIsSeen) {
  QuadraticTet t = straight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  t[4] = {0.5, 0.6, 0.6};
  const auto coefficients = jacobian_coefficients(t);
  EXPECT_LT(*std::min_element(coefficients.begin(), coefficients.end()), 0);
}

}  // namespace
}  // namespace symcell
