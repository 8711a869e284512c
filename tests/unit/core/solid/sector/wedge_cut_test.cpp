// The wedge between two half-planes: flags, boundary, and n wedges that make up the whole.
#include "core/solid/sector/wedge_cut.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/random.hpp"
#include "tests/unit/core/solid/surface_checks.hpp"

namespace symcell::solid {
namespace {

constexpr double kNoSnap = 1e-12;

double sector_angle(std::int32_t fold) {
  return 2 * std::numbers::pi / fold;
}

// The two flat sides of a wedge hold the axis: seen from a point on it they add no volume.
double wedge_volume(const WedgePatch& patch) {
  double six = 0;
  for (const Triangle& t : patch.triangles) {
    six += dot(patch.points[t[0]], cross(patch.points[t[1]], patch.points[t[2]]));
  }
  return six / 6;
}

double wedge_area(const WedgePatch& patch) {
  double twice = 0;
  for (const Triangle& t : patch.triangles) {
    twice += length(area_normal(patch.points[t[0]], patch.points[t[1]], patch.points[t[2]]));
  }
  return twice / 2;
}

// Flags, places, boundary and normals as the header defines them; triangles at vertices that were
// snapped have turned by up to `turned`.
void expect_sound_wedge(const WedgePatch& patch, double extent, double turned = 1e-12) {
  ASSERT_EQ(patch.on_lower.size(), patch.points.size());
  ASSERT_EQ(patch.on_higher.size(), patch.points.size());
  ASSERT_EQ(patch.normals.size(), patch.triangles.size());
  const double width = sector_angle(patch.fold);
  for (std::size_t i = 0; i < patch.points.size(); ++i) {
    const Point3 p = patch.points[i];
    if (patch.on_axis(static_cast<std::int32_t>(i))) {
      EXPECT_TRUE(p.x == 0 && p.y == 0);
      continue;
    }
    double angle = std::atan2(p.y, p.x) - patch.start_angle;
    const double rounding = 1e-14 * extent / std::hypot(p.x, p.y);
    while (angle < -rounding) angle += 2 * std::numbers::pi;
    if (patch.on_lower[i] != 0) {
      EXPECT_NEAR(angle, 0, rounding);
    } else if (patch.on_higher[i] != 0) {
      EXPECT_NEAR(angle, width, rounding);
    } else {
      EXPECT_GT(angle, 0);
      EXPECT_LT(angle, width);
    }
  }
  const std::vector<EdgeUse> uses = symcell::sorted_edge_uses(patch.triangles);
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    const std::int32_t a = uses[begin].low, b = uses[begin].high;
    const bool at_lower = patch.on_lower[a] != 0 && patch.on_lower[b] != 0;
    const bool at_upper = patch.on_higher[a] != 0 && patch.on_higher[b] != 0;
    // Open where it was cut and nowhere else.
    EXPECT_EQ(end - begin, at_lower || at_upper ? 1U : 2U);
    if (end - begin == 2) {
      EXPECT_NE(uses[begin].forward, uses[begin + 1].forward);
    }
  });
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    const Triangle& v = patch.triangles[t];
    const Point3 n = area_normal(patch.points[v[0]], patch.points[v[1]], patch.points[v[2]]);
    EXPECT_NEAR(length(patch.normals[t]), 1, 1e-14);
    EXPECT_NEAR(dot(n, patch.normals[t]), length(n), turned * extent * extent);
  }
}

TEST(WedgeCut, OfASymmetricBodyIsItsShare) {
  for (const std::int32_t fold : {2, 3, 5, 12}) {
    for (const double bore : {0.5, 0.0}) {
      PrismShape shape;
      shape.fold = fold;
      shape.bore = bore;
      const IndexedSurface whole = weld_exactly(asymmetric_prism(shape, 11));
      for (const double start : {0.123, 1.7, 5.2}) {
        SCOPED_TRACE(testing::Message() << fold << "-fold, bore " << bore << ", from " << start);
        const auto patch = cut_wedge(whole, fold, start, kNoSnap);
        ASSERT_TRUE(patch) << patch.error().message;
        EXPECT_EQ(patch->fold, fold);
        EXPECT_EQ(patch->start_angle, start);
        expect_sound_wedge(*patch, shape.outer);
        EXPECT_NEAR(wedge_volume(*patch), test::star_volume(shape) / fold, 1e-11);
        EXPECT_NEAR(wedge_area(*patch), surface_area(whole) / fold, 1e-11);
      }
    }
  }
}

// Nothing symmetric about it: the wedges still have all of the body between them.
TEST(WedgeCut, AllWedgesTogetherAreTheWholeBody) {
  Random random(4);
  for (int k = 0; k < 12; ++k) {
    TriangleSurface body = test::sphere(2);
    for (Point3& p : body.vertices) {
      p = {(1 + 0.2 * p.x * p.y) * p.x, p.y + 0.1 * p.z * p.x, 0.7 * p.z};
    }
    // Round the axis or beside it, in which case some wedges are empty.
    const Point3 shift{1.6 * random.uniform(), 0.8 * random.uniform(), random.uniform()};
    for (Point3& p : body.vertices) p = p + shift;
    const IndexedSurface whole = weld_exactly(body);
    const auto fold = 2 + static_cast<std::int32_t>(random.next() % 6);
    const double start = 6 * random.uniform();
    double volume = 0, area = 0;
    for (std::int32_t i = 0; i < fold; ++i) {
      const auto patch = cut_wedge(whole, fold, start + i * sector_angle(fold), kNoSnap);
      if (!patch) continue;
      expect_sound_wedge(*patch, 4);
      volume += wedge_volume(*patch);
      area += wedge_area(*patch);
    }
    EXPECT_NEAR(volume, test::volume_of(whole), 1e-11);
    EXPECT_NEAR(area, surface_area(whole), 1e-11);
  }
}

// A vertex just before the lower half-plane is put onto it if it is within the snap: else the edges
// that run on through the plane are cut there.
TEST(WedgeCut, SnapsVerticesNearAHalfPlane) {
  constexpr double kSnap = 1e-3, kStart = 0.6;
  for (const bool near : {true, false}) {
    for (const bool higher : {true, false}) {
      TriangleSurface body = test::sphere(2);
      const double plane = kStart + (higher ? sector_angle(4) : 0);
      const Point3 out{std::cos(plane), std::sin(plane), 0};
      const Point3 along{-out.y, out.x, 0};
      IndexedSurface whole = weld_exactly(body);
      const auto nearest = std::max_element(
          whole.points.begin(), whole.points.end(),
          [&](const Point3& p, const Point3& q) { return dot(p, out) < dot(q, out); });
      const Point3 placed = out + (near ? 0.8 : 1.6) * kSnap * along;
      *nearest = placed;
      const auto patch = cut_wedge(whole, 4, kStart, kSnap);
      ASSERT_TRUE(patch);
      const auto& flags = higher ? patch->on_higher : patch->on_lower;
      bool snapped = false;
      for (std::size_t v = 0; v < flags.size(); ++v) {
        snapped = snapped || (flags[v] != 0 && distance(patch->points[v], out) < 1e-12);
      }
      EXPECT_EQ(snapped, near);
    }
  }
}

// Near the axis, where the sector is narrower than the snap, vertices stay where they are.
TEST(WedgeCut, SnapsLessWhereTheSectorIsNarrow) {
  const std::int32_t fold = 30;
  PrismShape shape;
  shape.fold = fold;
  shape.bore = 0.05;
  const IndexedSurface whole = weld_exactly(asymmetric_prism(shape, 2));
  // The sector is 0.01 wide at the bore.
  const auto patch = cut_wedge(whole, fold, 0.03, 0.02);
  ASSERT_TRUE(patch);
  expect_sound_wedge(*patch, shape.outer, 0.01);
  EXPECT_NEAR(wedge_volume(*patch), test::star_volume(shape) / fold,
              0.05 * test::star_volume(shape) / fold);
}

TEST(WedgeCut, RefusesATriangleInAHalfPlaneAndNothingLeft) {
  for (const std::int32_t fold : {2, 4}) {
    const IndexedSurface box = weld_exactly(box_surface({1, 0, 0}, {2, 1, 1}));
    const auto flat = cut_wedge(box, fold, 0, kNoSnap);
    ASSERT_FALSE(flat);
    EXPECT_EQ(flat.error().code, ErrorCode::kInternal);
    EXPECT_TRUE(cut_wedge(box, fold, -0.1, kNoSnap));
    const auto nothing = cut_wedge(box, fold, 2, kNoSnap);
    EXPECT_EQ(nothing.has_value(), false);
  }
}

}  // namespace
}  // namespace symcell::solid
