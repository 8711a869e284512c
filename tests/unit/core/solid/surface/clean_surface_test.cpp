// What is mended in a surface as read, and what is refused.
#include "core/solid/surface/clean_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/self_intersections.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell::solid {
namespace {

TriangleSurface unit_box() {
  return box_surface({0, 0, 0}, {1, 1, 1});
}

TEST(CleanSurface, WeldsAndMeasures) {
  ExecutionContext context;
  const auto clean = clean_surface(unit_box(), context);
  ASSERT_TRUE(clean);
  EXPECT_FALSE(clean->problem);
  EXPECT_EQ(clean->surface.points.size(), 8U);
  EXPECT_DOUBLE_EQ(clean->volume, 1);
  EXPECT_DOUBLE_EQ(clean->area, 6);
  EXPECT_TRUE(clean->repairs.empty());
}

TEST(CleanSurface, WeldsJitteredCorners) {
  ExecutionContext context;
  TriangleSurface surface = unit_box();
  double jitter = 1e-6;
  for (Point3& p : surface.vertices) p.x += (jitter = -jitter);
  const auto clean = clean_surface(surface, context);
  ASSERT_TRUE(clean);
  EXPECT_FALSE(clean->problem);
  EXPECT_EQ(clean->surface.points.size(), 8U);
  EXPECT_EQ(clean->repairs.size(), 1U);
}

TEST(CleanSurface, OrientsAndTurns) {
  ExecutionContext context;
  TriangleSurface surface = unit_box();
  turn_inside_out(surface);
  std::swap(surface.triangles[4][0], surface.triangles[4][1]);
  const auto clean = clean_surface(surface, context);
  ASSERT_TRUE(clean);
  EXPECT_FALSE(clean->problem);
  EXPECT_DOUBLE_EQ(clean->volume, 1);
  EXPECT_EQ(clean->repairs.size(), 2U);
}

TEST(CleanSurface, NamesOpenEdges) {
  ExecutionContext context;
  TriangleSurface surface = unit_box();
  surface.triangles.pop_back();
  const auto clean = clean_surface(surface, context);
  ASSERT_TRUE(clean);
  ASSERT_TRUE(clean->problem);
  EXPECT_EQ(clean->problem->code, ErrorCode::kNotWatertight);
  EXPECT_NE(clean->problem->message.find("3 edges"), std::string::npos);
  EXPECT_FALSE(clean->problem->elements.empty());
}

TEST(CleanSurface, NamesInterpenetratingBodies) {
  ExecutionContext context;
  TriangleSurface surface = unit_box();
  append(surface, box_surface({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
  const auto clean = clean_surface(surface, context, kSurfaceSymmetryToleranceRel, Repair::kNone);
  ASSERT_TRUE(clean);
  ASSERT_TRUE(clean->problem);
  EXPECT_EQ(clean->problem->code, ErrorCode::kSelfIntersection);
  EXPECT_FALSE(clean->problem->elements.empty());
}

TEST(CleanSurface, RefusesWhatIsNoSurface) {
  ExecutionContext context;
  EXPECT_EQ(clean_surface({}, context).error().code, ErrorCode::kEmptyFile);
  TriangleSurface surface = unit_box();
  surface.vertices[5].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(clean_surface(surface, context).error().code, ErrorCode::kNonFinite);
  surface = unit_box();
  surface.triangles[3][1] = 400;
  EXPECT_EQ(clean_surface(surface, context).error().code, ErrorCode::kIndexOutOfRange);
  surface = unit_box();
  for (Point3& p : surface.vertices) p = {1, 2, 3};
  EXPECT_EQ(clean_surface(surface, context).error().code, ErrorCode::kDegenerateGeometry);
}

// A corner of the neighbours in the middle of an edge, and a triangle without area that covers it.
TEST(CleanSurface, JoinsVerticesInsideEdges) {
  for (const bool covered : {false, true}) {
    ExecutionContext context;
    TriangleSurface surface = unit_box();
    // The first two triangles are the bottom; the edge from (0,0,0) to (1,0,0) gets a vertex there.
    const auto corner = [](double x, double y) { return Point3{x, y, 0}; };
    surface.triangles.erase(surface.triangles.begin(), surface.triangles.begin() + 2);
    const auto add = [&](Point3 a, Point3 b, Point3 c) {
      const auto first = static_cast<std::int32_t>(surface.vertices.size());
      surface.vertices.insert(surface.vertices.end(), {a, b, c});
      surface.triangles.push_back({first, first + 1, first + 2});
    };
    add(corner(0, 0), corner(0, 1), corner(0.5, 0));
    add(corner(0, 1), corner(1, 1), corner(0.5, 0));
    add(corner(1, 1), corner(1, 0), corner(0.5, 0));
    if (covered) add(corner(0, 0), corner(0.5, 0), corner(1, 0));
    const auto clean = clean_surface(surface, context);
    ASSERT_TRUE(clean);
    EXPECT_FALSE(clean->problem) << clean->problem->message;
    EXPECT_DOUBLE_EQ(clean->volume, 1);
    EXPECT_EQ(clean->surface.points.size(), 9U);
    // Where it was covered the flip leaves as many triangles as before: 14 either way.
    EXPECT_EQ(clean->surface.triangles.size(), 14U);
  }
}

TEST(CleanSurface, SheetsEncloseNothing) {
  ExecutionContext context;
  TriangleSurface sheets = unit_box(), inside_out = unit_box();
  turn_inside_out(inside_out);
  append(sheets, inside_out);
  const auto clean = clean_surface(sheets, context);
  ASSERT_FALSE(clean);
  EXPECT_EQ(clean.error().code, ErrorCode::kDegenerateGeometry);
}

TEST(CleanSurface, NestsShells) {
  ExecutionContext context;
  TriangleSurface surface = unit_box();
  append(surface, box_surface({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}));
  append(surface, box_surface({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}));
  const auto clean = clean_surface(surface, context);
  ASSERT_TRUE(clean);
  EXPECT_FALSE(clean->problem);
  EXPECT_EQ(clean->shells, 3);
  EXPECT_NEAR(clean->volume, 1 - 0.125 + 0.008, 1e-12);
}

TEST(TriangleTree, FindsTheNearestTriangle) {
  const TriangleSurface box = unit_box();
  const TriangleTree tree(box.vertices, box.triangles);
  const auto hit = tree.nearest({0.5, 0.5, 3}, 10);
  EXPECT_DOUBLE_EQ(hit.squared, 4);
  EXPECT_EQ(hit.point, (Point3{0.5, 0.5, 1}));
  EXPECT_LT(tree.nearest({0.5, 0.5, 3}, 1).triangle, 0);
  EXPECT_TRUE(tree.within({0.5, 0.5, 1.5}, 0.6));
  EXPECT_FALSE(tree.within({0.5, 0.5, 1.5}, 0.4));
}

// Triangles of all sizes, some of them far away from the rest.
IndexedSurface random_triangles(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const auto place = [&](double size) {
    return Point3{size * random.uniform(), size * random.uniform(), size * random.uniform()};
  };
  IndexedSurface surface;
  for (std::size_t t = 0; t < count; ++t) {
    const Point3 at = place(10);
    const auto first = static_cast<std::int32_t>(surface.points.size());
    for (int i = 0; i < 3; ++i) surface.points.push_back(at + place(t % 7 == 0 ? 5 : 0.4));
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

TEST(TriangleTree, FindsTheSameWhereverTheSearchBegins) {
  const IndexedSurface surface = random_triangles(500, 1);
  const TriangleTree tree(surface.points, surface.triangles);
  Random random(2);
  std::int32_t last = -1;
  for (int i = 0; i < 500; ++i) {
    const Point3 p{12 * random.uniform() - 1, 12 * random.uniform() - 1, 12 * random.uniform() - 1};
    double nearest = std::numeric_limits<double>::infinity();
    std::int32_t triangle = -1;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const Triangle& v = surface.triangles[t];
      const double squared = squared_distance(
          p, closest_point(p, surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]));
      if (squared >= nearest) continue;
      nearest = squared;
      triangle = static_cast<std::int32_t>(t);
    }
    const double reach = std::sqrt(nearest);
    EXPECT_EQ(tree.nearest(p, 100).triangle, triangle);
    EXPECT_EQ(tree.nearest(p, 100, last).triangle, triangle);
    EXPECT_EQ(tree.within(p, 1.001 * reach, last), true);
    EXPECT_EQ(tree.within(p, 0.999 * reach, last), false);
    EXPECT_LT(tree.nearest(p, 0.999 * reach, last).triangle, 0);
  }
}

TEST(TriangleTree, VisitsEveryTwoBoxesThatMeetOnce) {
  const IndexedSurface surface = random_triangles(300, 3);
  const TriangleTree tree(surface.points, surface.triangles);
  const auto box = [&](std::size_t t) {
    return bounding_box(std::span(surface.points).subspan(3 * t, 3));
  };
  std::vector<std::pair<std::int32_t, std::int32_t>> expected, found;
  for (std::size_t s = 0; s < surface.triangles.size(); ++s) {
    for (std::size_t t = s + 1; t < surface.triangles.size(); ++t) {
      const Box3 a = box(s), b = box(t);
      const bool meet = a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y &&
                        b.low.y <= a.high.y && a.low.z <= b.high.z && b.low.z <= a.high.z;
      if (meet) expected.emplace_back(static_cast<std::int32_t>(s), static_cast<std::int32_t>(t));
    }
  }
  tree.visit_meeting_boxes([&](std::int32_t s, std::int32_t t) {
    found.emplace_back(std::min(s, t), std::max(s, t));
    return false;
  });
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected);
  int visits = 0;
  tree.visit_meeting_boxes([&](std::int32_t, std::int32_t) { return ++visits == 5; });
  EXPECT_EQ(visits, 5);
  TriangleTree().visit_meeting_boxes([](std::int32_t, std::int32_t) {
    ADD_FAILURE() << "of nothing";
    return false;
  });
}

// Two triangles at one side: only where the second is folded onto the first they intersect.
TEST(SelfIntersections, TellFoldedFromFlat) {
  ExecutionContext context;
  const auto count = [&](Point3 apex) {
    IndexedSurface surface;
    surface.points = {{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}, apex};
    surface.triangles = {{0, 1, 2}, {1, 0, 3}};
    const auto pairs = self_intersections(surface, 10, context);
    EXPECT_TRUE(pairs);
    return pairs ? pairs->size() : 0;
  };
  EXPECT_EQ(count({0.5, -1, 0}), 0U);
  EXPECT_EQ(count({0.5, -1e-200, 0}), 0U);
  EXPECT_EQ(count({0.5, 1e-200, 0}), 1U);
  EXPECT_EQ(count({0.5, 0.5, 0}), 1U);
  EXPECT_EQ(count({0.5, 0.5, 1e-300}), 0U);
  EXPECT_EQ(count({5, 1e-9, 1e-30}), 0U);
}

}  // namespace
}  // namespace symcell::solid
