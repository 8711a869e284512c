// Planar patches: what is flat within the tolerances becomes exactly flat, and nothing else.
#include "core/solid/surface/planar_patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "core/base/random.hpp"
#include "tests/unit/core/solid/surface_checks.hpp"

namespace symcell::solid {
namespace {

constexpr FlatnessTolerances kTolerances{1e-6, 1e-5};

void flatten(QuotientSurface& surface) {
  ExecutionContext context;
  const auto done = flatten_planar_patches(surface, kTolerances, context);
  ASSERT_TRUE(done) << done.error().message;
}

void jitter(QuotientSurface& surface, double by, std::uint64_t seed) {
  Random random(seed);
  for (Point3& p : surface.points) {
    const auto one = [&] { return by * (2 * random.uniform() - 1); };
    p = p + Point3{one(), one(), one()};
  }
}

// Patches, as they are: in their planes within rounding, two triangles each at least. Their number.
std::size_t expect_flat(const QuotientSurface& s) {
  EXPECT_EQ(s.patch.size(), s.triangles.size());
  EXPECT_EQ(s.frame.size(), s.triangles.size());
  const RotationTable rotations(s.fold);
  std::multiset<std::int32_t> members;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.patch[t] < 0) continue;
    members.insert(s.patch[t]);
    const Plane plane = rotated(s.planes[s.patch[t]], rotations, s.frame[t]);
    EXPECT_NEAR(length(plane.normal), 1, 1e-14);
    std::vector<Point3> p;
    for (const OrbitVertex& v : s.triangles[t]) {
      p.push_back(corner_point(s, rotations, v));
      EXPECT_LE(std::abs(plane.height(p.back())), 1e-11 * 3);
    }
    EXPECT_GT(dot(area_normal(p[0], p[1], p[2]), plane.normal), 0);
    if (plane.normal.x == 0 && plane.normal.y == 0) {
      EXPECT_EQ(s.frame[t], 0);
    }
  }
  const std::set<std::int32_t> patches(members.begin(), members.end());
  for (const std::int32_t p : patches) EXPECT_GE(members.count(p), 2U);
  return patches.size();
}

std::size_t in_no_patch(const QuotientSurface& s) {
  return static_cast<std::size_t>(std::count(s.patch.begin(), s.patch.end(), -1));
}

TEST(PlanarPatches, ACubeHasSix) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    TriangleSurface cube = test::divided(test::divided(box_surface({0, 0, 0}, {1, 1, 1})));
    if (seed > 1) move_to_axis(cube, {0.1, 0.2, -0.3}, {1, -2, static_cast<double>(seed)});
    QuotientSurface surface = test::uncut(cube);
    jitter(surface, 0.5 * kTolerances.noise, seed);
    const QuotientSurface before = surface;
    flatten(surface);
    EXPECT_EQ(expect_flat(surface), 6U);
    EXPECT_EQ(in_no_patch(surface), 0U);
    EXPECT_EQ(surface.triangles, before.triangles);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const Point3 normal = surface.planes[surface.patch[t]].normal;
      EXPECT_GT(dot(normal, surface.normals[t]), 1 - 1e-10);
    }
    for (std::size_t v = 0; v < surface.points.size(); ++v) {
      EXPECT_LT(distance(surface.points[v], before.points[v]), 3 * kTolerances.noise);
    }
    EXPECT_NEAR(full_volume(surface), 1, 6 * kTolerances.noise);
  }
}

// Bottom, top, two sides of a star a sector, as many of a bore: those that are cut are one patch
// across it, seen in two frames.
TEST(PlanarPatches, OfASectorGoOnAcrossTheCut) {
  for (const std::int32_t fold : {2, 3, 5, 12}) {
    for (const double bore : {0.5, 0.0}) {
      PrismShape shape;
      shape.fold = fold;
      shape.bore = bore;
      QuotientSurface surface = test::one_sector(asymmetric_prism(shape, 3), fold, 0.2);
      flatten(surface);
      test::expect_sound(surface);
      EXPECT_EQ(expect_flat(surface), bore > 0 ? 6U : 4U);
      EXPECT_EQ(in_no_patch(surface), 0U);
      EXPECT_NEAR(full_volume(surface), test::star_volume(shape), 1e-10);
      std::set<std::int32_t> frames(surface.frame.begin(), surface.frame.end());
      EXPECT_EQ(frames.size(), 2U);
    }
  }
}

TEST(PlanarPatches, CurvedPartsHaveNone) {
  QuotientSurface ball = test::uncut(test::sphere(3));
  const std::vector<Point3> points = ball.points;
  flatten(ball);
  EXPECT_EQ(expect_flat(ball), 0U);
  EXPECT_EQ(ball.points, points);
  PrismShape shape;
  shape.twist = 0.6;
  shape.pieces = 1;  // else triangles at one straight line are flat indeed
  shape.bore = 0;
  QuotientSurface twisted = test::uncut(asymmetric_prism(shape, 4));
  flatten(twisted);
  EXPECT_EQ(expect_flat(twisted), 2U);  // bottom and top
}

// A vertex inside a face that is farther off than a large patch may be: only what it is a corner of
// is left out, the rest of the face stays one patch.
TEST(PlanarPatches, LeaveOutWhatIsNotFlat) {
  for (const double off : {0.5, 4.0}) {
    QuotientSurface surface =
        test::uncut(test::divided(test::divided(box_surface({0, 0, 0}, {1, 1, 1}))));
    const Point3 place{0.5, 0.5, 1};
    const auto v = std::find(surface.points.begin(), surface.points.end(), place);
    ASSERT_NE(v, surface.points.end());
    v->z += off * kTolerances.most;
    const auto id = static_cast<std::int32_t>(v - surface.points.begin());
    flatten(surface);
    EXPECT_EQ(expect_flat(surface), 6U);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& c = surface.triangles[t];
      const bool at = c[0].orbit == id || c[1].orbit == id || c[2].orbit == id;
      EXPECT_EQ(surface.patch[t] < 0, at && off > 1);
    }
  }
}

// More than three planes at the tip of a pyramid have no common point once they are rounded: the
// smaller patches lose their triangles there and nothing else.
TEST(PlanarPatches, TooManyPlanesAtAVertex) {
  constexpr std::int32_t kSides = 6;
  TriangleSurface pyramid;
  for (std::int32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    pyramid.vertices.push_back({std::cos(angle), std::sin(angle), 0});
    const std::int32_t j = (i + 1) % kSides;
    pyramid.triangles.push_back({i, j, kSides});
    pyramid.triangles.push_back({j, i, kSides + 1});
  }
  pyramid.vertices.push_back({0, 0, 1});
  pyramid.vertices.push_back({0, 0, 0});
  QuotientSurface surface = test::uncut(test::divided(test::divided(pyramid)));
  jitter(surface, 0.5 * kTolerances.noise, 5);
  flatten(surface);
  EXPECT_EQ(expect_flat(surface), kSides + 1U);
  EXPECT_EQ(in_no_patch(surface), kSides - 3U);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.patch[t] >= 0) continue;
    double highest = 0;
    for (const OrbitVertex& v : surface.triangles[t]) {
      highest = std::max(highest, surface.points[v.orbit].z);
    }
    EXPECT_NEAR(highest, 1, 1e-4);
  }
}

TEST(PlanarPatches, BentAndTurnedTrianglesAreDropped) {
  const QuotientSurface given = [] {
    QuotientSurface s =
        test::uncut(test::divided(test::divided(box_surface({0, 0, 0}, {1, 1, 1}))));
    flatten(s);
    return s;
  }();
  const auto v = std::find(given.points.begin(), given.points.end(), Point3{0.5, 0.5, 1});
  ASSERT_NE(v, given.points.end());
  const auto id = static_cast<std::size_t>(v - given.points.begin());
  const auto dropped = [&](Point3 move) {
    QuotientSurface s = given;
    s.points[id] = s.points[id] + move;
    drop_bent_triangles(s);
    expect_flat(s);
    return in_no_patch(s);
  };
  std::size_t at = 0;
  for (const QuotientTriangle& c : given.triangles) {
    for (const OrbitVertex& x : c) at += static_cast<std::size_t>(x.orbit) == id ? 1 : 0;
  }
  EXPECT_EQ(dropped({}), 0U);
  EXPECT_EQ(dropped({0.05, 0.02, 0}), 0U);
  EXPECT_EQ(dropped({0, 0, 1e-9}), at);
  EXPECT_EQ(dropped({0, 0, -1e-9}), at);
  // In its plane, but past its neighbours.
  const std::size_t turned = dropped({0.3, 0.1, 0});
  EXPECT_GT(turned, 0U);
  EXPECT_LT(turned, at);
}

TEST(PlanarPatches, RefuseWhatIsNotClosed) {
  QuotientSurface surface = test::uncut(test::sphere(1));
  surface.triangles.pop_back();
  ExecutionContext context;
  EXPECT_EQ(flatten_planar_patches(surface, kTolerances, context).error().code,
            ErrorCode::kInternal);
}

}  // namespace
}  // namespace symcell::solid
