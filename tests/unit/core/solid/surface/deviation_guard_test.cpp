// A change is allowed exactly as long as the surface stays within the distance of what it was, both
// ways, and faces the same way.
#include "core/solid/surface/deviation_guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/unit/core/solid/surface_checks.hpp"

namespace symcell::solid {
namespace {

constexpr double kMost = 0.01;

// A cube with a vertex in the middle of its top.
struct Cube {
  QuotientSurface surface =
      test::uncut(test::divided(test::divided(box_surface({0, 0, 0}, {1, 1, 1}))));
  EditableSurface mesh = *EditableSurface::create(surface);
  std::int32_t top = static_cast<std::int32_t>(
      std::find(surface.points.begin(), surface.points.end(), Point3{0.5, 0.5, 1}) -
      surface.points.begin());
};

TEST(DeviationGuard, AllowsMovesWithinTheDistanceOnly) {
  Cube cube;
  DeviationGuard guard(cube.surface, kMost);
  EXPECT_EQ(guard.most(), kMost);
  const Point3 from = cube.surface.points[cube.top];
  const auto allowed = [&](Point3 way) {
    return guard.allows(cube.mesh.star(cube.top), cube.mesh.plan_move(cube.top, from + way));
  };
  for (const double sign : {1.0, -1.0}) {
    EXPECT_TRUE(allowed({0, 0, sign * 0.9 * kMost}));
    // The old vertex is farther than that from all that would be there.
    EXPECT_FALSE(allowed({0, 0, sign * 1.1 * kMost}));
    EXPECT_FALSE(allowed({0, 0, sign * 10 * kMost}));
  }
  // Far along the face, where nothing deviates, but not so far that triangles turn over.
  EXPECT_TRUE(allowed({0.1, 0.05, 0}));
  EXPECT_FALSE(allowed({0.4, 0.3, 0}));
  guard.relax(2);
  EXPECT_EQ(guard.most(), 2 * kMost);
  EXPECT_TRUE(allowed({0, 0, 1.9 * kMost}));
  EXPECT_FALSE(allowed({0, 0, 2.1 * kMost}));
}

TEST(DeviationGuard, NothingAccumulates) {
  Cube cube;
  DeviationGuard guard(cube.surface, kMost);
  int done = 0;
  double height = 0;
  for (int i = 0; i < 10; ++i) {
    const Point3 place = cube.surface.points[cube.top] + Point3{0.01, 0, 0.3 * kMost};
    const std::vector<std::int32_t> gone = cube.mesh.star(cube.top);
    const auto planned = cube.mesh.plan_move(cube.top, place);
    if (!guard.allows(gone, planned)) break;
    guard.commit(gone, planned);
    cube.mesh.move(cube.top, place);
    height = place.z - 1;
    ++done;
  }
  EXPECT_EQ(done, 3);
  EXPECT_LE(height, kMost);
}

// A tent over a square whose top is off the middle: planes through the square's corners.
//      3 +-------+ 2      The flat triangles that may take its place are 0 1 2 and 0 2 3. All
//        |       |        points of them that are looked at are within 0.2 of the tent, while its
//        | 4     |        top, 0.3 high, is that far from either.
//      0 +-------+ 1
struct Tent {
  QuotientSurface surface;
  std::vector<std::int32_t> gone{0, 1, 2, 3};
  std::vector<PlannedTriangle> flat;

  Tent() {
    surface.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0.5, 2, 0.3}};
    surface.on_axis.assign(5, 0);
    surface.on_cut.assign(5, 0);
    for (std::int32_t i = 0; i < 4; ++i) {
      surface.triangles.push_back({OrbitVertex{i, 0}, {(i + 1) % 4, 0}, {4, 0}});
    }
    for (const QuotientTriangle& t : surface.triangles) {
      const auto p = points(t);
      const Point3 n = area_normal(p[0], p[1], p[2]);
      surface.normals.push_back((1 / length(n)) * n);
    }
    test::give_no_patches(surface);
    flat = {planned(0, {0, 1, 2}), planned(1, {0, 2, 3})};
  }
  [[nodiscard]] std::array<Point3, 3> points(const QuotientTriangle& t) const {
    return {surface.points[t[0].orbit], surface.points[t[1].orbit], surface.points[t[2].orbit]};
  }
  [[nodiscard]] PlannedTriangle planned(std::int32_t id, const Triangle& t) const {
    const QuotientTriangle corners{OrbitVertex{t[0], 0}, {t[1], 0}, {t[2], 0}};
    return {id, corners, points(corners)};
  }
};

TEST(DeviationGuard, WhatIsLeftBehindCountsToo) {
  const Tent tent;
  EXPECT_FALSE(DeviationGuard(tent.surface, 0.25).allows(tent.gone, tent.flat));
  EXPECT_TRUE(DeviationGuard(tent.surface, 0.31).allows(tent.gone, tent.flat));
  // Nothing left behind, but a triangle far from all that was there.
  std::vector<PlannedTriangle> more;
  for (std::int32_t i = 0; i < 4; ++i) more.push_back(tent.planned(i, {i, (i + 1) % 4, 4}));
  EXPECT_TRUE(DeviationGuard(tent.surface, 0.25).allows(tent.gone, more));
  more.push_back(tent.flat[0]);
  for (Point3& p : more.back().points) p.z += 1;
  EXPECT_FALSE(DeviationGuard(tent.surface, 0.25).allows(tent.gone, more));
  // Where it should be, but turned over.
  std::vector<PlannedTriangle> turned{tent.planned(0, {0, 2, 1}), tent.planned(1, {0, 3, 2})};
  EXPECT_FALSE(DeviationGuard(tent.surface, 0.31).allows(tent.gone, turned));
}

// A triangle that stands on the top of the cube by its base, so high and so steep.
TEST(DeviationGuard, TrianglesFaceAsTheSurfaceDid) {
  Cube cube;
  DeviationGuard guard(cube.surface, kMost);
  const auto allowed = [&](double height, double tilt_deg) {
    const double tilt = tilt_deg * std::numbers::pi / 180;
    const PlannedTriangle p{0,
                            {OrbitVertex{0, 0}, {1, 0}, {2, 0}},
                            {Point3{0.3, 0.5, 1},
                             {0.7, 0.5, 1},
                             {0.5, 0.5 + height * std::cos(tilt), 1 + height * std::sin(tilt)}}};
    return guard.allows({}, {&p, 1});
  };
  EXPECT_TRUE(allowed(2.05 * kMost, 44));
  EXPECT_FALSE(allowed(2.05 * kMost, 46));
  // Thin ones show less of the way they face.
  EXPECT_TRUE(allowed(kMost, 60));
  EXPECT_TRUE(allowed(kMost, 80));
  EXPECT_FALSE(allowed(kMost, 90));
}

// What was followed unasked is still owed: by the triangle nearest to it, under its later number.
TEST(DeviationGuard, SamplesPassOnFromTriangleToTriangle) {
  const Tent tent;
  DeviationGuard guard(tent.surface, 0.25);
  guard.follow(tent.gone, tent.flat);
  guard.commit(tent.gone, tent.flat);
  const auto one = [&](std::int32_t id, std::size_t which) {
    PlannedTriangle same = tent.flat[which];
    same.id = id;
    const std::vector<std::int32_t> gone{id};
    const std::vector<PlannedTriangle> planned{same};
    return guard.allows(gone, planned);
  };
  EXPECT_TRUE(one(0, 0));
  EXPECT_FALSE(one(1, 1));  // the top was over it
  EXPECT_TRUE(one(2, 1));   // nothing is left to the others
  EXPECT_TRUE(one(3, 1));
  guard.renumber({1, 0});
  EXPECT_FALSE(one(0, 1));
  EXPECT_TRUE(one(1, 0));
}

TEST(DeviationGuard, HeightsAreMeasuredAlongTheNormal) {
  Cube cube;
  DeviationGuard guard(cube.surface, kMost);
  for (const double height : {-1.5, -0.3, 0.0, 0.7, 1.9, 2.1}) {
    const double z = 1 - height * kMost;
    const std::array<Point3, 3> below{Point3{0.2, 0.2, z}, {0.8, 0.3, z}, {0.4, 0.7, z}};
    // Farther than two deviations away nothing is known.
    EXPECT_NEAR(guard.mean_height(0, below), std::abs(height) < 2 ? height * kMost : 0, 1e-14);
    EXPECT_NEAR(guard.mean_height(0, {below[1], below[0], below[2]}), 0, 1e-14);
  }
  const auto hit = guard.nearest({0.3, 0.4, 1.5}, 0.6);
  EXPECT_EQ(hit.point, (Point3{0.3, 0.4, 1}));
  EXPECT_LT(guard.nearest({0.3, 0.4, 1.5}, 0.4).triangle, 0);
}

}  // namespace
}  // namespace symcell::solid
