// The two cuts of a wedge become one curve: what comes out is closed under the rotation, with the
// vertices of both cuts and the shape of the lower one.
#include "core/solid/sector/glue_cuts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/solid/sector/cut_curves.hpp"
#include "core/solid/sector/match_curves.hpp"
#include "tests/unit/core/solid/surface_checks.hpp"

namespace symcell::solid {
namespace {

constexpr double kNoSnap = 1e-12;

// Distance from the axis, and height.
Point2 flat(Point3 p) {
  return {std::hypot(p.x, p.y), p.z};
}

bool any_near(const std::vector<Point3>& points, Point2 p, double reach) {
  return std::any_of(points.begin(), points.end(),
                     [&](const Point3& q) { return distance(flat(q), p) <= reach; });
}

std::vector<Point3> cut_points(const QuotientSurface& s) {
  std::vector<Point3> points;
  for (std::size_t v = 0; v < s.points.size(); ++v) {
    if (s.on_cut[v] != 0) points.push_back(s.points[v]);
  }
  return points;
}

WedgePatch wedge_of(const PrismShape& shape, std::uint64_t seed, double start) {
  auto patch = cut_wedge(weld_exactly(asymmetric_prism(shape, seed)), shape.fold, start, kNoSnap);
  EXPECT_TRUE(patch);
  return patch ? *patch : WedgePatch{};
}

// Every vertex of the higher cut, the axis apart, goes away from the axis.
void push_out(WedgePatch& patch, double by) {
  for (std::size_t v = 0; v < patch.points.size(); ++v) {
    if (patch.on_higher[v] == 0 || patch.on_lower[v] != 0) continue;
    Point3& p = patch.points[v];
    const double r = std::hypot(p.x, p.y);
    p = {(1 + by / r) * p.x, (1 + by / r) * p.y, p.z};
  }
}

class GluedPrisms : public testing::TestWithParam<std::int32_t> {};

TEST_P(GluedPrisms, AreClosedAndKeepBothCurves) {
  constexpr double kMerge = 1e-7;
  for (const double bore : {0.5, 0.0}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      PrismShape shape;
      shape.fold = GetParam();
      shape.bore = bore;
      const WedgePatch patch = wedge_of(shape, seed, 0.31 * static_cast<double>(seed));
      ExecutionContext context;
      const auto glued = glue_cuts(patch, 1e-6, kMerge, context);
      ASSERT_TRUE(glued) << glued.error().message;
      const QuotientSurface& s = glued->surface;
      EXPECT_EQ(s.fold, shape.fold);
      EXPECT_EQ(s.start_angle, patch.start_angle);
      test::expect_sound(s);
      EXPECT_LT(glued->largest_move, 1e-12);
      EXPECT_NEAR(full_volume(s), test::star_volume(shape), 1e-10);
      EXPECT_EQ(s.normals.size(), s.triangles.size());
      EXPECT_EQ(test::euler_characteristic(test::restored(s)), bore > 0 ? 0 : 2);
      // All vertices of both cuts, and no others; the triangles differ from side to side, so that
      // either cut has some of its own.
      const std::vector<Point3> common = cut_points(s);
      std::size_t lower = 0, higher = 0;
      std::vector<Point3> all;
      for (std::size_t v = 0; v < patch.points.size(); ++v) {
        if (patch.on_lower[v] == 0 && patch.on_higher[v] == 0) continue;
        lower += patch.on_lower[v];
        higher += patch.on_higher[v];
        all.push_back(patch.points[v]);
        EXPECT_TRUE(any_near(common, flat(patch.points[v]), kMerge));
      }
      for (const Point3& p : common) EXPECT_TRUE(any_near(all, flat(p), kMerge));
      EXPECT_GE(common.size(), std::max(lower, higher));
      EXPECT_LE(common.size(), lower + higher);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Folds, GluedPrisms, testing::Values(2, 3, 5, 12));

TEST(GlueCuts, TellsTheLargestMoveAndTakesTheLowerShape) {
  constexpr double kReach = 1e-3, kOff = 4e-4;
  for (const double bore : {0.5, 0.0}) {
    PrismShape shape;
    shape.bore = bore;
    WedgePatch patch = wedge_of(shape, 6, 0.4);
    std::vector<std::vector<Point2>> lower;
    const auto curves = find_cut_curves(patch);
    ASSERT_TRUE(curves);
    for (const CutCurve& c : curves->lower) lower.push_back(curve_points(patch, c));
    push_out(patch, kOff);
    ExecutionContext context;
    const auto glued = glue_cuts(patch, kReach, 2 * kOff, context);
    ASSERT_TRUE(glued) << glued.error().message;
    test::expect_sound(glued->surface);
    EXPECT_NEAR(glued->largest_move, kOff, 1e-12);
    // What stands in the half-plane is the lower curve, to the last digits.
    for (const Point3& p : cut_points(glued->surface)) {
      double nearest = 1;
      for (const auto& curve : lower) {
        for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
          const Point2 a = curve[i], d = curve[i + 1] - a;
          const double t = std::clamp(dot(flat(p) - a, d) / squared_length(d), 0.0, 1.0);
          nearest = std::min(nearest, distance(flat(p), a + t * d));
        }
      }
      EXPECT_LT(nearest, 1e-13);
    }
  }
}

TEST(GlueCuts, RefusesCurvesFartherApartThanTheReach) {
  constexpr double kReach = 1e-3;
  for (const double bore : {0.5, 0.0}) {
    PrismShape shape;
    shape.bore = bore;
    for (const double share : {0.3, 0.9, 1.1}) {
      for (const double merge : {kReach, 0.3 * kReach}) {
        WedgePatch patch = wedge_of(shape, 6, 0.4);
        push_out(patch, share * kReach);
        ExecutionContext context;
        const auto glued = glue_cuts(patch, kReach, merge, context);
        // Corners that are not merged go round each other, and farther than the curves are apart.
        if (share > 1 || share * kReach < merge) {
          EXPECT_EQ(glued.has_value(), share < 1);
        }
        if (glued) {
          EXPECT_LE(glued->largest_move, kReach);
        } else {
          EXPECT_EQ(glued.error().code, ErrorCode::kInternal);
        }
      }
    }
  }
}

// A body in one sector only reaches across one of the cuts: that curve has no image.
TEST(GlueCuts, RefusesACurveWithoutImage) {
  TriangleSurface surface = asymmetric_prism({}, 3);
  append(surface, box_surface({3, -0.3, 0}, {3.5, 0.3, 0.5}));
  ExecutionContext context;
  const auto patch = cut_wedge(weld_exactly(surface), 5, 0.05, kNoSnap);
  ASSERT_TRUE(patch);
  const auto glued = glue_cuts(*patch, 1e-3, 1e-4, context);
  ASSERT_FALSE(glued);
  EXPECT_EQ(glued.error().code, ErrorCode::kInternal);
}

// Twisted sides are chords of a curved part: the two cuts cross them at different places.
TEST(GlueCuts, MatchesCurvesOfDifferentChords) {
  PrismShape shape;
  shape.fold = 7;
  shape.twist = 0.1;
  shape.layers = 12;
  shape.pieces = 6;
  const WedgePatch patch = wedge_of(shape, 5, 0.2);
  ExecutionContext context;
  const double reach = 0.02;
  const auto glued = glue_cuts(patch, reach, 0.3 * reach, context);
  ASSERT_TRUE(glued) << glued.error().message;
  test::expect_sound(glued->surface);
  EXPECT_GT(glued->largest_move, 1e-6);
  EXPECT_LE(glued->largest_move, reach);
}

TEST(GlueCuts, CanBeCancelled) {
  ExecutionContext context;
  context.cancel();
  const auto glued = glue_cuts(wedge_of({}, 1, 0.4), 1e-6, 1e-7, context);
  ASSERT_FALSE(glued);
  EXPECT_EQ(glued.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace symcell::solid
