#include "core/geometry/triangle_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/base/random.hpp"

namespace symcell {
namespace {

// Points of a triangle are their own nearest points, however thin it is and whichever of its corners
// comes first.
TEST(ClosestPoint, InThinTriangles) {
  for (const double height : {1.0, 0.1, 0.02, 0.01, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    for (const double foot : {0.0, 0.3, 1.0, -0.5}) {
      std::array<Point3, 3> corners{Point3{0.1, 0.2, 0.3}, Point3{-0.9, 1.2, 0.7}, Point3{}};
      const Point3 along = corners[1] - corners[0];
      corners[2] = corners[0] + foot * along + Point3{height, height, 0};
      const Point3 inside = 0.2 * corners[0] + 0.3 * corners[1] + 0.5 * corners[2];
      std::array<std::size_t, 3> order{0, 1, 2};
      do {
        const Point3 nearest =
            closest_point(inside, corners[order[0]], corners[order[1]], corners[order[2]]);
        EXPECT_LT(distance(inside, nearest), 5e-14) << height << ' ' << foot;
      } while (std::next_permutation(order.begin(), order.end()));
    }
  }
}

// Among many triangles the ray meets what it meets of each alone.
TEST(TriangleTree, RaysMeetTheFirstTriangle) {
  Random random(9);
  const auto point = [&](double size) {
    return Point3{size * (random.uniform() - 0.5), size * (random.uniform() - 0.5),
                  size * (random.uniform() - 0.5)};
  };
  std::vector<Point3> points;
  std::vector<Triangle> triangles;
  for (std::int32_t t = 0; t < 200; ++t) {
    const Point3 middle = point(10);
    for (int i = 0; i < 3; ++i) points.push_back(middle + point(2));
    triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const TriangleTree all(points, triangles);
  std::vector<TriangleTree> alone;
  for (const Triangle& t : triangles) alone.emplace_back(points, std::span(&t, 1));
  int met = 0;
  for (int i = 0; i < 300; ++i) {
    const Point3 from = point(12), to = point(8);
    // Some run along an axis, in which boxes have sides.
    const Point3 direction = i % 4 == 0 ? Point3{0, 0, 1} : (1 / distance(from, to)) * (to - from);
    TriangleTree::Meeting wanted;
    for (std::size_t t = 0; t < alone.size(); ++t) {
      const TriangleTree::Meeting one = alone[t].first_met(from, direction);
      if (one.distance < wanted.distance) wanted = {static_cast<std::int32_t>(t), one.distance};
    }
    const TriangleTree::Meeting found = all.first_met(from, direction);
    EXPECT_EQ(found.triangle, wanted.triangle);
    EXPECT_EQ(found.distance, wanted.distance);
    met += found.triangle >= 0 ? 1 : 0;
  }
  EXPECT_GT(met, 100);
}

}  // namespace
}  // namespace symcell
