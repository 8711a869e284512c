// The axes that a PLC may have: the true one is always among them, with a fold that the true fold
// divides.
#include "core/solid/symmetry/plc_axes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/random.hpp"
#include "tests/support/plc_builders.hpp"
#include "tests/support/random_plc.hpp"

namespace symcell::solid {
namespace {

constexpr double kTolerance = 1e-7;

PlcComplex complex_of(const Plc& plc) {
  ExecutionContext context;
  auto made = make_plc_complex(plc, context);
  EXPECT_TRUE(made) << made.error().message;
  return made ? std::move(*made) : PlcComplex{};
}

bool is_axis(const AxisFrame& frame, Point3 origin, Point3 direction, double size) {
  const Point3 d = (1 / length(direction)) * direction;
  return length(cross(frame.direction(), d)) < 1e-7 &&
         length(cross(frame.origin - origin, d)) < 1e-7 * size;
}

// The candidate that is this axis.
const AxisCandidate* find_axis(const std::vector<AxisCandidate>& list,
                               Point3 origin,
                               Point3 direction,
                               double size = 1) {
  const auto it = std::find_if(list.begin(), list.end(), [&](const AxisCandidate& c) {
    return is_axis(c.frame, origin, direction, size);
  });
  return it == list.end() ? nullptr : &*it;
}

void expect_sorted(const std::vector<AxisCandidate>& list) {
  for (std::size_t i = 1; i < list.size(); ++i) {
    EXPECT_GE(list[i - 1].greatest_fold, list[i].greatest_fold);
  }
}

TEST(PlcAxes, OfPrismsMovedAnywhere) {
  Random random(1);
  for (const std::int32_t n : {3, 4, 5, 6, 7, 12, 31}) {
    for (int i = 0; i < 5; ++i) {
      Plc plc = test::prism(n, 1, 2.7);
      const Point3 origin{20 * random.uniform() - 10, 5 * random.uniform(), -3};
      const Point3 direction{2 * random.uniform() - 1, 2 * random.uniform() - 1, random.uniform()};
      const AxisFrame frame = AxisFrame::of_axis(origin, direction);
      for (Point3& p : plc.vertices) p = frame.to_model(p);
      const AxisCandidates found = principal_axes(complex_of(plc), {}, {}, kTolerance);
      expect_sorted(found.list);
      // The two moments across the axis are equal.
      EXPECT_TRUE(found.open);
      EXPECT_FALSE(found.isotropic);
      const AxisCandidate* axis = find_axis(found.list, origin, direction);
      ASSERT_NE(axis, nullptr);
      EXPECT_EQ(axis->greatest_fold, n);
    }
  }
}

TEST(PlcAxes, OfRandomModels) {
  int scattered = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const test::RandomPlc model = test::make_random_plc(seed);
    if (model.fold == 1) continue;
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + model.description);
    const PlcComplex complex = complex_of(model.plc);
    const double tolerance = 1e-9 * model.diameter;
    const auto found = principal_axes(complex, {}, {}, tolerance);
    const AxisCandidate* axis =
        find_axis(found.list, model.axis_origin, model.axis_direction, model.diameter);
    // Elsewhere only where equal moments leave it open.
    std::vector<AxisCandidate> others;
    if (axis == nullptr) {
      EXPECT_TRUE(found.open);
      others = scattered_axes(complex, {}, tolerance);
      expect_sorted(others);
      axis = find_axis(others, model.axis_origin, model.axis_direction, model.diameter);
      ++scattered;
    }
    ASSERT_NE(axis, nullptr);
    EXPECT_EQ(axis->greatest_fold % model.fold, 0) << axis->greatest_fold;
  }
  EXPECT_LT(scattered, 30);
}

TEST(PlcAxes, GivenOnesAreTaken) {
  const PlcComplex complex = complex_of(test::box({0, 0, 0}, {1, 2, 3}));
  const Point3 middle{0.5, 1, 1.5}, corner{0, 0, 0};
  auto found = principal_axes(complex, {}, Point3{0, 4, 0}, kTolerance);
  ASSERT_EQ(found.list.size(), 1U);
  EXPECT_TRUE(is_axis(found.list[0].frame, middle, {0, 1, 0}, 1));
  EXPECT_EQ(found.list[0].greatest_fold, 4);
  // Four vertices lie alone at their distance and height from there.
  found = principal_axes(complex, corner, Point3{0, 4, 0}, kTolerance);
  ASSERT_EQ(found.list.size(), 1U);
  EXPECT_TRUE(is_axis(found.list[0].frame, corner, {0, 1, 0}, 1));
  EXPECT_EQ(found.list[0].greatest_fold, 1);
  found = principal_axes(complex, corner, {}, kTolerance);
  for (const AxisCandidate& c : found.list) EXPECT_EQ(c.frame.origin, corner);
}

TEST(PlcAxes, EqualMomentsLeaveThemOpen) {
  const auto found = [](Point3 size) {
    return principal_axes(complex_of(test::box({0, 0, 0}, size)), {}, {}, kTolerance);
  };
  EXPECT_FALSE(found({1, 2, 3}).open);
  EXPECT_FALSE(found({1, 2, 3}).isotropic);
  EXPECT_TRUE(found({2, 2, 3}).open);
  EXPECT_FALSE(found({2, 2, 3}).isotropic);
  EXPECT_TRUE(found({2, 2, 2}).open);
  EXPECT_TRUE(found({2, 2, 2}).isotropic);
  // All three of a plain box.
  const Point3 middle{0.5, 1, 1.5};
  const AxisCandidates box = found({1, 2, 3});
  for (const Point3 d : {Point3{1, 0, 0}, Point3{0, 1, 0}, Point3{0, 0, 1}}) {
    const AxisCandidate* axis = find_axis(box.list, middle, d);
    ASSERT_NE(axis, nullptr);
    EXPECT_EQ(axis->greatest_fold, 4);
  }
}

// A cube has three axes of fold 4, four of fold 3 and six of fold 2, however it lies.
TEST(PlcAxes, OfACubeAreScattered) {
  Random random(7);
  for (int i = 0; i < 5; ++i) {
    Plc cube = test::box({-1, -1, -1}, {1, 1, 1});
    AxisFrame frame;
    if (i > 0) frame = AxisFrame::of_axis({3, -4, random.uniform()}, {random.uniform(), 0.3, -1});
    for (Point3& p : cube.vertices) p = frame.to_model(p);
    const auto list = scattered_axes(complex_of(cube), {}, kTolerance);
    expect_sorted(list);
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const int parts = std::abs(x) + std::abs(y) + std::abs(z);
          if (parts == 0) continue;
          const Point3 d = frame.to_model({1.0 * x, 1.0 * y, 1.0 * z}) - frame.origin;
          const AxisCandidate* axis = find_axis(list, frame.origin, d);
          ASSERT_NE(axis, nullptr) << x << y << z;
          EXPECT_EQ(axis->greatest_fold % (parts == 1 ? 4 : parts == 2 ? 2 : 3), 0);
        }
      }
    }
  }
}

// The numbers at equal distance and height count, not the places: 6 and 4 allow half a turn.
TEST(PlcAxes, TheFoldDividesAllNumbersOfVertices) {
  PlcComplex complex;
  const auto ring = [&](int count, double radius, double z) {
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count + z;
      complex.points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
  };
  const auto fold = [&] {
    const auto found = principal_axes(complex, Point3{}, Point3{0, 0, 1}, kTolerance);
    return found.list.at(0).greatest_fold;
  };
  complex.points = {{0, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(fold(), 0);  // all on the axis
  ring(6, 1, 0);
  EXPECT_EQ(fold(), 6);
  ring(4, 1, 0.5);
  EXPECT_EQ(fold(), 2);
  ring(9, 2, 0.5);
  EXPECT_EQ(fold(), 1);
}

}  // namespace
}  // namespace symcell::solid
