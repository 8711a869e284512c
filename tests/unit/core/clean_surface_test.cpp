// What is mended in a surface as read, and what is refused.
#include "core/surface/clean_surface.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/surface/triangle_tree.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell {
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

TEST(CleanSurface, RefusesInterpenetratingBodies) {
  ExecutionContext context;
  TriangleSurface surface = unit_box();
  append(surface, box_surface({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
  const auto clean = clean_surface(surface, context);
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

}  // namespace
}  // namespace symcell
