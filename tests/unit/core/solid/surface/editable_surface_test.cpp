// Single edits of a quotient surface: plans say what they do, and what is done can be found from
// the surface.
#include "core/solid/surface/editable_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/unit/core/solid/editable_checks.hpp"

namespace symcell::solid {
namespace {

using test::slots;

TEST(EditableSurface, RefusesWhatIsNotClosed) {
  QuotientSurface surface = test::sample(5);
  surface.triangles.pop_back();
  EXPECT_EQ(EditableSurface::create(surface).error().code, ErrorCode::kInternal);
}

// A flat cone: its rim is the only crease, and a corner of it where it turns by more than 35 degrees.
TEST(EditableSurface, CreasesAreLeftAlongThemWhereTheyHardlyTurn) {
  for (const std::int32_t corners : {8, 12}) {
    TriangleSurface cone;
    for (std::int32_t i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners;
      cone.vertices.push_back({std::cos(angle), std::sin(angle), 0});
      const std::int32_t j = (i + 1) % corners;
      cone.triangles.push_back({i, j, corners});
      cone.triangles.push_back({j, i, corners + 1});
    }
    cone.vertices.push_back({0, 0, 0.5});
    cone.vertices.push_back({0, 0, 0});
    QuotientSurface surface = test::uncut(cone);
    auto mesh = EditableSurface::create(surface);
    ASSERT_TRUE(mesh);
    for (std::int32_t t = 0; t < slots(*mesh); ++t) {
      for (std::int32_t side = 0; side < 3; ++side) {
        const auto p = mesh->points(t);
        const Point3 a = p[side], b = p[(side + 1) % 3];
        const bool from_rim = length(a) == length(Point2{a.x, a.y}) && length(a) > 0.5;
        const bool at_rim = a.z == 0 && b.z == 0 && length(a) > 0.5 && length(b) > 0.5;
        EXPECT_EQ(mesh->mark(t, side), at_rim ? kCreaseSide : 0);
        EXPECT_EQ(mesh->may_leave(t, side, true), !from_rim || (at_rim && corners == 12));
      }
    }
  }
}

TEST(EditableSurface, AFlipTwiceIsNone) {
  for (QuotientSurface& surface : test::samples()) {
    auto mesh = EditableSurface::create(surface);
    ASSERT_TRUE(mesh);
    const auto edges = [&] {
      std::vector<std::array<std::int32_t, 3>> all;
      for (const QuotientEdgeUse& e : sorted_edge_uses(surface)) {
        all.push_back({e.low, e.high, e.exponent});
      }
      return all;
    };
    int done = 0;
    for (std::int32_t t = 0; t < slots(*mesh); ++t) {
      for (std::int32_t side = 0; side < 3; ++side) {
        const auto plan = mesh->plan_flip(t, side);
        if (!plan) continue;
        EXPECT_EQ(mesh->mark(t, side), 0);
        const auto before = edges();
        mesh->flip(*plan);
        EXPECT_NE(edges(), before);
        // The diagonal of the first of the two triangles runs from its second corner to its third.
        const auto back = mesh->plan_flip(plan->changed[0].id, 1);
        // In a cut surface the two may be joined another way round already.
        const std::int32_t a = plan->changed[0].corners[0].orbit;
        const std::int32_t b = plan->changed[1].corners[1].orbit;
        const auto has_a = [&](std::int32_t o) {
          const QuotientTriangle& c = surface.triangles[o];
          return c[0].orbit == a || c[1].orbit == a || c[2].orbit == a;
        };
        const auto& star = mesh->star(b);
        ASSERT_EQ(back.has_value(), std::none_of(star.begin(), star.end(), has_a));
        ASSERT_TRUE(back || surface.fold > 1);
        if (!back) break;
        mesh->flip(*back);
        EXPECT_EQ(edges(), before);
        ++done;
      }
    }
    test::expect_consistent(*mesh);
    EXPECT_GT(done, 10);
  }
}

TEST(EditableSurface, ASplitLeavesTheSurface) {
  for (QuotientSurface& surface : test::samples()) {
    const IndexedSurface before = test::restored(surface);
    auto mesh = EditableSurface::create(surface);
    ASSERT_TRUE(mesh);
    int at_cut = 0;
    const std::int32_t given = slots(*mesh);
    for (std::int32_t t = 0; t < given; ++t) {
      for (std::int32_t side = 0; side < 3; ++side) {
        const std::uint8_t mark = mesh->mark(t, side);
        const auto p = mesh->points(t);
        const std::size_t vertices = surface.points.size();
        if (mesh->split(t, side).size() != 4) continue;
        ASSERT_EQ(surface.points.size(), vertices + 1);
        const auto v = static_cast<std::int32_t>(vertices);
        EXPECT_EQ(mesh->star(v).size(), 4U);
        // The triangle keeps its number and begins with the first half.
        EXPECT_EQ(mesh->mark(t, 0), mark);
        EXPECT_LT(distance(mesh->points(t)[1], 0.5 * (p[side] + p[(side + 1) % 3])), 1e-14);
        EXPECT_EQ(surface.on_cut[vertices] != 0, (mark & kCutSide) != 0);
        at_cut += surface.on_cut[vertices];
      }
    }
    test::expect_consistent(*mesh);
    mesh->compact();
    test::expect_sound(surface);
    const IndexedSurface after = test::restored(surface);
    EXPECT_NEAR(test::volume_of(after), test::volume_of(before), 1e-12);
    EXPECT_LT(test::distance_between(before, after), 1e-13);
    EXPECT_EQ(at_cut > 0, surface.fold > 1);
  }
}

// A vertex of the cut is moved at both its images, which its triangles see in different frames.
TEST(EditableSurface, AMoveIsPlannedAsItIsDone) {
  for (QuotientSurface& surface : test::samples()) {
    auto mesh = EditableSurface::create(surface);
    ASSERT_TRUE(mesh);
    const RotationTable rotations(surface.fold);
    for (std::size_t i = 0; i < surface.points.size(); ++i) {
      const auto v = static_cast<std::int32_t>(i);
      const Point3 from = surface.points[i], place = 1.1 * from;
      const auto planned = mesh->plan_move(v, place);
      EXPECT_EQ(planned.size(), mesh->star(v).size());
      EXPECT_EQ(surface.points[i], from);
      mesh->move(v, place);
      test::expect_as_planned(*mesh, planned);
      for (const std::int32_t t : mesh->star(v)) {
        std::size_t k = 0;
        while (surface.triangles[t][k].orbit != v) ++k;
        const Point3 back = mesh->in_frame_of(v, t, mesh->points(t)[k]);
        EXPECT_LT(distance(back, place), 1e-13);
      }
      mesh->move(v, from);
    }
  }
}

}  // namespace
}  // namespace symcell::solid
