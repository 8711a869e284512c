// Corners of curved parts below the bound are opened, all others are left as they are.
#include "core/solid/surface/narrow_corners.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/surface/planar_patches.hpp"
#include "tests/unit/core/solid/surface_checks.hpp"

namespace symcell::solid {
namespace {

constexpr double kMost = 0.02;
constexpr double kRounding = 1e-11;
// Twice the distance is allowed here; it is looked at in more places than the guard does.
constexpr double kAllowed = 2.5;

// Of curved parts, by the law of cosines.
int narrow_corners_of(const QuotientSurface& s) {
  const RotationTable rotations(s.fold);
  int count = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.patch[t] >= 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 x = corner_point(s, rotations, s.triangles[t][i]);
      const Point3 u = corner_point(s, rotations, s.triangles[t][(i + 1) % 3]) - x;
      const Point3 v = corner_point(s, rotations, s.triangles[t][(i + 2) % 3]) - x;
      count += dot(u, v) > std::cos(kNarrowCorner) * length(u) * length(v) ? 1 : 0;
    }
  }
  return count;
}

void open_corners(QuotientSurface& surface, double most = kMost) {
  auto mesh = EditableSurface::create(surface);
  ASSERT_TRUE(mesh);
  DeviationGuard guard(surface, most);
  ExecutionContext context;
  ASSERT_TRUE(NarrowCorners(*mesh, guard, kRounding, context).open());
  EXPECT_EQ(guard.most(), 2 * most);
  mesh->compact();
}

// Some vertices along the sphere to near a neighbour.
void make_narrow(QuotientSurface& ball, int count, std::uint64_t seed) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const QuotientTriangle& t = ball.triangles[random.next() % ball.triangles.size()];
    if (ball.on_cut[t[0].orbit] != 0 || t[0].exponent + t[1].exponent != 0) continue;
    Point3& p = ball.points[t[0].orbit];
    p = p + 0.75 * (ball.points[t[1].orbit] - p);
    p = (1 / length(p)) * p;
  }
}

TEST(NarrowCorners, TheBoundIsThatOfTheRatio) {
  // Circumradius over the side opposite to the corner.
  EXPECT_NEAR(1 / (2 * std::sin(kNarrowCorner)), MeshOptions{}.radius_edge, 1e-3);
}

TEST(NarrowCorners, AreOpenedOnCurvedParts) {
  for (const std::int32_t fold : {1, 4}) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
      QuotientSurface ball =
          fold == 1 ? test::uncut(test::sphere(3)) : test::one_sector(test::sphere(3), 4, 0.35);
      make_narrow(ball, 12, seed);
      const int before = narrow_corners_of(ball);
      const IndexedSurface was = test::restored(ball);
      open_corners(ball);
      test::expect_sound(ball);
      EXPECT_GT(before, 8);
      EXPECT_LT(narrow_corners_of(ball), before / 3);
      EXPECT_LT(test::distance_between(was, test::restored(ball)), kAllowed * kMost);
      EXPECT_EQ(test::euler_characteristic(test::restored(ball)), 2);
    }
  }
}

// A vertex somewhere in a box's top face, which nothing keeps from going back.
TEST(NarrowCorners, OnlyThoseBelowTheBound) {
  const QuotientSurface given = test::uncut(test::divided(box_surface({0, 0, 0}, {1, 1, 1})));
  const auto v = std::find(given.points.begin(), given.points.end(), Point3{0.5, 0.5, 1});
  ASSERT_NE(v, given.points.end());
  Random random(3);
  int opened = 0, left = 0;
  for (int i = 0; i < 200; ++i) {
    QuotientSurface box = given;
    box.points[static_cast<std::size_t>(v - given.points.begin())] = {
        0.2 + 0.6 * random.uniform(), 0.2 + 0.6 * random.uniform(), 1};
    const QuotientSurface before = box;
    const int narrow = narrow_corners_of(box);
    open_corners(box);
    ++(narrow > 0 ? opened : left);
    if (narrow == 0) {
      EXPECT_EQ(box.points, before.points);
      EXPECT_EQ(box.triangles, before.triangles);
    } else {
      EXPECT_EQ(narrow_corners_of(box), 0);
      test::expect_sound(box);
      EXPECT_NEAR(full_volume(box), 1, 1e-12);
    }
  }
  EXPECT_GT(opened, 20);
  EXPECT_GT(left, 20);
}

TEST(NarrowCorners, OfPlanarPatchesAreLeft) {
  QuotientSurface box = test::uncut(test::divided(box_surface({0, 0, 0}, {1, 1, 1})));
  const auto v = std::find(box.points.begin(), box.points.end(), Point3{0.5, 0.5, 1});
  ASSERT_NE(v, box.points.end());
  *v = Point3{0.5, 0.1, 1};
  ExecutionContext context;
  ASSERT_TRUE(flatten_planar_patches(box, {1e-9, 1e-9}, context));
  EXPECT_EQ(std::count(box.patch.begin(), box.patch.end(), -1), 0);
  const QuotientSurface before = box;
  open_corners(box);
  EXPECT_EQ(box.points, before.points);
  EXPECT_EQ(box.triangles, before.triangles);
}

TEST(NarrowCorners, KeepTheDistance) {
  for (const double most : {1e-6, 1e-3, 4e-3, 1e-2}) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
      QuotientSurface ball = test::uncut(test::sphere(2));
      make_narrow(ball, 12, seed);
      const IndexedSurface was = test::restored(ball);
      open_corners(ball, most);
      test::expect_sound(ball);
      EXPECT_LT(test::distance_between(was, test::restored(ball)), kAllowed * most);
    }
  }
}

TEST(NarrowCorners, CanBeCancelled) {
  QuotientSurface ball = test::uncut(test::sphere(2));
  make_narrow(ball, 8, 1);
  auto mesh = EditableSurface::create(ball);
  ASSERT_TRUE(mesh);
  DeviationGuard guard(ball, kMost);
  ExecutionContext context;
  context.cancel();
  const auto done = NarrowCorners(*mesh, guard, kRounding, context).open();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace symcell::solid
