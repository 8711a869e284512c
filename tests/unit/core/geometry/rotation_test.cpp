#include "core/geometry/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace symcell {
namespace {

constexpr Point2 kUnit{1, 0};

TEST(RotationTable, QuarterTurnsAreExact) {
  const Point2 p{0.1, -7.3};
  for (const std::int32_t n : {4, 8, 12, 64, 100, 30'000}) {
    const RotationTable table(n);
    EXPECT_EQ(table.rotate(p, 0), p);
    EXPECT_EQ(table.rotate(p, n / 4), (Point2{-p.y, p.x}));
    EXPECT_EQ(table.rotate(p, n / 2), (Point2{-p.x, -p.y}));
    EXPECT_EQ(table.rotate(p, 3 * (n / 4)), (Point2{p.y, -p.x}));
  }
  EXPECT_EQ(RotationTable(2).rotate(p, 1), (Point2{-p.x, -p.y}));
}

TEST(RotationTable, InverseIsTheTranspose) {
  for (std::int32_t n = 1; n <= 300; ++n) {
    const RotationTable table(n);
    for (std::int32_t k = 1; k < n; ++k) {
      const Point2 forth = table.rotate(kUnit, k), back = table.rotate(kUnit, n - k);
      EXPECT_EQ(forth.x, back.x) << k << " of " << n;
      EXPECT_EQ(forth.y, -back.y) << k << " of " << n;
    }
  }
}

TEST(RotationTable, EveryExponentIsRightToTheLastBit) {
  constexpr double kError = 2.3e-16;
  for (const std::int32_t n : {3, 5, 7, 17, 36, 97, 100, 720, 30'000}) {
    const RotationTable table(n);
    for (std::int32_t k = 0; k < n; ++k) {
      const long double angle = 2 * std::numbers::pi_v<long double> * k / n;
      const Point2 p = table.rotate(kUnit, k);
      EXPECT_LE(std::abs(static_cast<double>(p.x - std::cos(angle))), kError) << k << " of " << n;
      EXPECT_LE(std::abs(static_cast<double>(p.y - std::sin(angle))), kError) << k << " of " << n;
    }
  }
}

TEST(RotationTable, ExponentsAddModuloTheFold) {
  for (const std::int32_t n : {1, 2, 5, 12}) {
    const RotationTable table(n);
    for (std::int32_t a = 0; a < n; ++a) {
      for (std::int32_t b = 0; b < n; ++b) {
        EXPECT_EQ(table.add(a, b), (a + b) % n);
        EXPECT_EQ(table.add(table.subtract(a, b), b), a);
        EXPECT_EQ(table.reduce(a - std::int64_t{7} * n * b), a);
      }
    }
  }
}

}  // namespace
}  // namespace symcell
