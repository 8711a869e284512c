// The one-sided distance of triangles from a surface, against what is known of simple ones.
#include "core/geometry/surface_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace symcell {
namespace {

// A square of `size` in z = 0, of n by n cells of two triangles each.
IndexedSurface plate(double size, std::int32_t n) {
  IndexedSurface s;
  for (std::int32_t i = 0; i <= n; ++i) {
    for (std::int32_t j = 0; j <= n; ++j) s.points.push_back({size * i / n, size * j / n, 0});
  }
  for (std::int32_t i = 0; i < n; ++i) {
    for (std::int32_t j = 0; j < n; ++j) {
      const std::int32_t a = i * (n + 1) + j, b = a + n + 1;
      s.triangles.push_back({a, b, b + 1});
      s.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return s;
}

struct Target {
  explicit Target(IndexedSurface s)
      : surface(std::move(s)), tree(surface.points, surface.triangles) {}
  IndexedSurface surface;
  TriangleTree tree;
};

TEST(DistanceBound, LargeTrianglesOverFineSurfacesAreNearOrNot) {
  const Target target(plate(10, 40));
  for (const double height : {0.0, 0.05, 0.0999}) {
    DistanceBound bound(target.tree, 0.1);
    EXPECT_FALSE(bound.beyond({{{0, 0, height}, {10, 0, -height}, {10, 10, height}}})) << height;
  }
  DistanceBound bound(target.tree, 0.1);
  EXPECT_TRUE(bound.beyond({{{0, 0, 0.11}, {10, 0, 0}, {10, 10, 0}}}));
  EXPECT_TRUE(bound.beyond({{{0, 0, 0}, {10.11, 0, 0}, {10, 10, 0}}}));
  // All corners and the middle lie on the surface.
  const Target gap([] {
    IndexedSurface s = plate(10, 40);
    std::erase_if(s.triangles, [&](const Triangle& t) {
      const Point3 m = (1.0 / 3) * (s.points[t[0]] + s.points[t[1]] + s.points[t[2]]);
      return std::abs(m.x - 8) < 0.3 && std::abs(m.y - 3) < 0.3;
    });
    return s;
  }());
  DistanceBound of_gap(gap.tree, 0.1);
  const auto found = of_gap.beyond({{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}}});
  ASSERT_TRUE(found);
  EXPECT_LT(std::hypot(found->x - 8, found->y - 3), 0.6);
}

// What stands up between its corners and its middle: a bulge that samples miss.
TEST(DistanceBound, ABulgeBetweenSamplesIsFound) {
  IndexedSurface tent;
  tent.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.23, 0.31, 0.2}};
  tent.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const Target target(tent);
  const std::array<Point3, 3> flat = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}};
  DistanceBound strict(target.tree, 0.05);
  const auto found = strict.beyond(flat);
  ASSERT_TRUE(found);
  EXPECT_FALSE(target.tree.within(*found, 0.05 * (1 - 1.0 / 16)));
  DistanceBound wide(target.tree, 0.2);
  EXPECT_FALSE(wide.beyond(flat));
}

// Against dense samples: nothing that they show is missed, nothing is told that is clearly near.
TEST(DistanceBound, AgreesWithDenseSamplesOfRandomTriangles) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  int near_ones = 0, far_ones = 0;
  for (int round = 0; round < 400; ++round) {
    IndexedSurface rough = plate(1, 5);
    const double roughness = 0.2 * share(random);
    for (Point3& p : rough.points) p.z = roughness * share(random);
    const Target target(rough);
    std::array<Point3, 3> t;
    for (Point3& p : t) p = {share(random), share(random), roughness * share(random)};
    double farthest = 0;
    constexpr int kSteps = 120;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const double u = 1.0 * i / kSteps, v = 1.0 * j / kSteps;
        const Point3 p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
        farthest = std::max(farthest, target.tree.nearest(p, 10).squared);
      }
    }
    farthest = std::sqrt(farthest);
    const double reach = 0.01 + 0.15 * share(random);
    DistanceBound bound(target.tree, reach);
    const auto found = bound.beyond(t);
    (found ? far_ones : near_ones)++;
    EXPECT_TRUE(found || farthest <= reach) << round;
    EXPECT_FALSE(found && target.tree.within(*found, (1 - 1.0 / 32) * reach)) << round;
  }
  EXPECT_GT(near_ones, 50);
  EXPECT_GT(far_ones, 50);
}

// Walls that meet the triangle's plane in a side are nearest to it there, and cover nothing.
TEST(DistanceBound, WallsBesideAFaceDoNotHoldItUp) {
  IndexedSurface box;
  constexpr int kSides = 36;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * 3.14159265358979 * i / kSides;
    for (const double z : {0.0, -3.0}) box.points.push_back({std::cos(angle), std::sin(angle), z});
    for (const double z : {0.0, -3.0}) {
      box.points.push_back({4 * std::cos(angle), 4 * std::sin(angle), z});
    }
  }
  for (int i = 0; i < kSides; ++i) {
    const std::int32_t a = 4 * i, b = 4 * ((i + 1) % kSides);
    for (const auto& [p, q] :
         {std::pair(0, 1), std::pair(0, 2), std::pair(2, 3), std::pair(1, 3)}) {
      box.triangles.push_back({a + p, b + p, b + q});
      box.triangles.push_back({a + p, b + q, a + q});
    }
  }
  const Target target(box);
  for (const double reach : {0.003, 0.01, 0.05}) {
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * 3.14159265358979 * (i + 0.5) / kSides, half = 0.5;
      DistanceBound bound(target.tree, reach);
      const auto at = [&](double r, double turn) -> Point3 {
        return {r * std::cos(angle + turn), r * std::sin(angle + turn), 0};
      };
      // Reaches over the middle of a side of the bore.
      const double sagitta = 1 - std::cos(3.14159265358979 / kSides);
      EXPECT_FALSE(bound.beyond({at(1 - sagitta - 0.9 * reach, 0), at(3, half), at(3, -half)}));
      EXPECT_TRUE(bound.beyond({at(1 - sagitta - 1.1 * reach, 0), at(3, half), at(3, -half)}));
    }
  }
}

// Triangles of the surface that have a corner of the part beside them, and nothing over them.
TEST(DistanceBound, PartsBesideTheirNearestTriangleAreTaken) {
  IndexedSurface fan;
  fan.points = {{0, 0, 0}};
  constexpr int kBlades = 24;
  for (int i = 0; i < kBlades; ++i) {
    const double angle = 0.26 * i;
    fan.points.push_back({std::cos(angle), std::sin(angle), 0.02 * (i % 3)});
    if (i > 0) fan.triangles.push_back({0, i, i + 1});
  }
  const Target target(fan);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(-1.2, 1.2);
  int near_ones = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::array<Point3, 3> t;
    for (Point3& p : t) p = {share(random), share(random), 0.02};
    DistanceBound bound(target.tree, 0.3);
    const auto found = bound.beyond(t);
    near_ones += found ? 0 : 1;
    for (const Point3& p : t) EXPECT_TRUE(found || target.tree.within(p, 0.3));
  }
  EXPECT_GT(near_ones, 100);
}

TEST(DistanceBound, TrianglesOfNoAreaAreTakenToo) {
  const Target target(plate(1, 3));
  DistanceBound bound(target.tree, 0.01);
  EXPECT_FALSE(bound.beyond({{{0, 0, 0}, {0.5, 0.5, 0}, {1, 1, 0}}}));
  EXPECT_FALSE(bound.beyond({{{0.2, 0.2, 0}, {0.2, 0.2, 0}, {0.2, 0.2, 0}}}));
  EXPECT_TRUE(bound.beyond({{{0, 0, 0}, {0.5, 0.5, 0}, {2, 2, 0}}}));
  IndexedSurface needle;
  needle.points = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}};
  needle.triangles = {{0, 1, 2}};
  const Target flat(needle);
  DistanceBound of_needle(flat.tree, 0.01);
  EXPECT_FALSE(of_needle.beyond({{{0, 0, 0}, {1, 0, 0}, {0.5, 0.009, 0}}}));
  EXPECT_TRUE(of_needle.beyond({{{0, 0, 0}, {1, 0, 0}, {0.5, 0.02, 0}}}));
}

}  // namespace
}  // namespace symcell
