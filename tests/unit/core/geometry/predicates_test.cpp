// Laws of the exact predicates, on generators that are near-degenerate on purpose, with a tally of
// the stage that decided: a filter that never fails, or never succeeds, would show.
#include "core/geometry/predicates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace symcell {
namespace {

class PointSource {
 public:
  explicit PointSource(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

  Point2 generic() { return {uniform(-1, 1), uniform(-1, 1)}; }
  Point2 grid() {
    return {static_cast<double>(integer(-3, 3)), static_cast<double>(integer(-3, 3))};
  }
  // On a line through a and b, moved by up to a few units in the last place.
  Point2 near_line(Point2 a, Point2 b) {
    const double t = uniform(-2, 3);
    return nudge({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
  }
  Point2 near_unit_circle() {
    const double angle = uniform(0, 6.3);
    return nudge({std::cos(angle), std::sin(angle)});
  }
  Point2 nudge(Point2 p) {
    const auto move = [this](double x) {
      const int steps = integer(-2, 2);
      for (int i = 0; i < std::abs(steps); ++i) x = std::nextafter(x, steps < 0 ? -9e99 : 9e99);
      return x;
    };
    return {move(p.x), move(p.y)};
  }

 private:
  std::mt19937_64 engine_;
};

struct Tally {
  int filter = 0;
  int exact_nonzero = 0;
  int exact_zero = 0;
};

Point2 scaled(Point2 p, double scale, Point2 offset) {
  return {scale * p.x + offset.x, scale * p.y + offset.y};
}

void check_orientation(Point2 a, Point2 b, Point2 c, Tally& tally) {
  const Sign s = orientation(a, b, c);
  const Sign exact = internal::orientation_exact(a, b, c);
  ASSERT_EQ(s, exact);
  ASSERT_EQ(s, orientation(b, c, a));
  ASSERT_EQ(s, -orientation(b, a, c));
  ASSERT_EQ(s, -orientation(a, c, b));
  if (internal::orientation_filter(a, b, c) != Sign::kZero) {
    ++tally.filter;
  } else {
    ++(exact == Sign::kZero ? tally.exact_zero : tally.exact_nonzero);
  }
}

void check_in_circle(Point2 a, Point2 b, Point2 c, Point2 d, Tally& tally) {
  const Sign s = in_circle(a, b, c, d);
  const Sign exact = internal::in_circle_exact(a, b, c, d);
  ASSERT_EQ(s, exact);
  ASSERT_EQ(s, in_circle(b, c, a, d));
  ASSERT_EQ(s, -in_circle(b, a, c, d));
  ASSERT_EQ(s, -in_circle(a, b, d, c));
  if (internal::in_circle_filter(a, b, c, d) != Sign::kZero) {
    ++tally.filter;
  } else {
    ++(exact == Sign::kZero ? tally.exact_zero : tally.exact_nonzero);
  }
}

constexpr double kScales[] = {1.0, 1e-4, 1e4, 1e-60, 1e59, 3.7e-170};

TEST(Predicates, OrientationKeepsItsLawsNearDegeneracy) {
  Tally tally;
  PointSource source(1);
  for (int i = 0; i < 60000; ++i) {
    const double scale = kScales[static_cast<std::size_t>(source.integer(0, 5))];
    const Point2 offset = source.integer(0, 1) != 0 ? scale * 1000.0 * source.generic() : Point2{};
    const bool on_grid = source.integer(0, 2) == 0;
    const Point2 a = scaled(on_grid ? source.grid() : source.generic(), scale, offset);
    const Point2 b = scaled(on_grid ? source.grid() : source.generic(), scale, offset);
    const Point2 c = on_grid                     ? scaled(source.grid(), scale, offset)
                     : source.integer(0, 1) != 0 ? source.near_line(a, b)
                                                 : scaled(source.generic(), scale, offset);
    check_orientation(a, b, c, tally);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(tally.filter, 10000);
  EXPECT_GT(tally.exact_nonzero, 1000);
  EXPECT_GT(tally.exact_zero, 1000);
}

TEST(Predicates, InCircleKeepsItsLawsNearDegeneracy) {
  Tally tally;
  PointSource source(2);
  for (int i = 0; i < 60000; ++i) {
    const double scale = kScales[static_cast<std::size_t>(source.integer(0, 4))];
    const int kind = source.integer(0, 2);
    Point2 p[4];
    for (Point2& q : p) {
      q = kind == 0 ? source.generic() : kind == 1 ? source.grid() : source.near_unit_circle();
      q = scale * q;
    }
    check_in_circle(p[0], p[1], p[2], p[3], tally);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(tally.filter, 10000);
  EXPECT_GT(tally.exact_nonzero, 1000);
  EXPECT_GT(tally.exact_zero, 1000);
}

TEST(Predicates, SignsAreAsDocumented) {
  const Point2 a{0, 0}, b{1, 0}, c{0, 1};
  EXPECT_EQ(orientation(a, b, c), Sign::kPositive);
  EXPECT_EQ(orientation(a, b, {2, 0}), Sign::kZero);
  EXPECT_EQ(in_circle(a, b, c, {0.5, 0.5}), Sign::kPositive);
  EXPECT_EQ(in_circle(a, b, c, {1, 1}), Sign::kZero);
  EXPECT_EQ(in_circle(a, b, c, {2, 2}), Sign::kNegative);
}

TEST(Predicates, TinyDifferencesDoNotUnderflowToZero) {
  // The products are about 1e-340, below the smallest double.
  EXPECT_EQ(orientation({0, 0}, {1e-170, 0}, {0, 1e-170}), Sign::kPositive);
  EXPECT_EQ(in_circle({0, 0}, {1e-90, 0}, {0, 1e-90}, {5e-91, 5e-91}), Sign::kPositive);
}

}  // namespace
}  // namespace symcell
