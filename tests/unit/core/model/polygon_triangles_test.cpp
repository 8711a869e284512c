#include "core/model/polygon_triangles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/base/index.hpp"

namespace symcell {
namespace {

Point3 area_vector(const TriangleSurface& surface, const std::array<std::int32_t, 3>& t) {
  const Point3 a = surface.vertices[at(t[0])];
  return 0.5 * cross(surface.vertices[at(t[1])] - a, surface.vertices[at(t[2])] - a);
}

// Cuts a polygon through all vertices in their order: every triangle must be turned as `normal`,
// and their areas sum up to `area`.
void expect_cut(const std::vector<Point3>& corners, const Point3& normal, double area) {
  TriangleSurface surface;
  surface.vertices = corners;
  std::vector<std::int32_t> polygon(corners.size());
  std::iota(polygon.begin(), polygon.end(), 0);
  const auto done = append_polygon(polygon, 5, surface);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(surface.triangles.size(), corners.size() - 2);
  EXPECT_EQ(surface.source_face, std::vector<std::int32_t>(surface.triangles.size(), 5));
  double sum = 0;
  for (const auto& t : surface.triangles) {
    const Point3 v = area_vector(surface, t);
    EXPECT_GT(dot(v, normal), 0);
    sum += std::sqrt(dot(v, v));
  }
  EXPECT_NEAR(sum, area, 1e-9 * area);
}

TEST(PolygonTriangles, ConvexOnesAreFans) {
  expect_cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 0, 1}, 1);
  expect_cut({{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}, {0, 0, -1}, 1);
}

TEST(PolygonTriangles, ConcaveOnesInAnyPlane) {
  // An L, its reflex corner such that the fan of the first corner would leave it.
  const std::vector<Point2> shape = {{0, 2}, {0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}};
  const auto place = [&](auto map) {
    std::vector<Point3> corners;
    for (const Point2 p : shape) corners.push_back(map(p));
    return corners;
  };
  expect_cut(place([](Point2 p) { return Point3{p.x, p.y, 7}; }), {0, 0, 1}, 3);
  expect_cut(place([](Point2 p) { return Point3{p.x, 1e5, p.y}; }), {0, -1, 0}, 3);
  expect_cut(place([](Point2 p) { return Point3{-4, p.x, p.y}; }), {1, 0, 0}, 3);
  expect_cut(place([](Point2 p) {
               return Point3{p.x, p.y, p.x + p.y};
             }),
             {-1, -1, 1}, 3 * std::sqrt(3.0));
}

TEST(PolygonTriangles, CornersInARowAndCombs) {
  // The fan of the first corner has a triangle without area.
  expect_cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {0, 0, 1}, 4);
  std::vector<Point3> comb;
  for (int i = 0; i < 20; ++i) {
    comb.push_back({2.0 * i, 0, 0});
    comb.push_back({2.0 * i + 1, 0, 0});
    comb.push_back({2.0 * i + 1, 9, 0});
    comb.push_back({2.0 * i + 2, 9, 0});
  }
  comb.push_back({40, 10, 0});
  comb.push_back({0, 10, 0});
  expect_cut(comb, {0, 0, 1}, 40 * 1 + 20 * 9);
}

TEST(PolygonTriangles, ManyCorners) {
  std::vector<Point3> star;
  constexpr int kTips = 2000;
  double area = 0;
  for (int i = 0; i < 2 * kTips; ++i) {
    const double angle = std::numbers::pi * i / kTips;
    const double r = i % 2 == 0 ? 2 : 1;
    star.push_back({r * std::cos(angle), r * std::sin(angle), 0});
  }
  for (std::size_t i = 0; i < star.size(); ++i) {
    area += 0.5 * cross(star[i], star[(i + 1) % star.size()]).z;
  }
  expect_cut(star, {0, 0, 1}, area);
}

TEST(PolygonTriangles, BadOnes) {
  TriangleSurface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::int32_t twice[] = {0, 1, 2, 1};
  const auto done = append_polygon(twice, 3, surface);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kDegenerateFacet);
  EXPECT_EQ(done.error().elements, std::vector<std::int64_t>{3});
  // A triangle may be anything: cleaning the surface deals with it.
  const std::int32_t flat[] = {1, 1, 2};
  EXPECT_TRUE(append_polygon(flat, 4, surface));
  // What crosses itself, or has no area, stays a fan.
  const std::int32_t bow_tie[] = {0, 2, 1, 3};
  EXPECT_TRUE(append_polygon(bow_tie, 5, surface));
  EXPECT_EQ(surface.triangles.size(), 3U);
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  const std::int32_t line[] = {0, 1, 2, 3};
  EXPECT_TRUE(append_polygon(line, 6, surface));
  EXPECT_EQ(surface.triangles.size(), 5U);
}

}  // namespace
}  // namespace symcell
