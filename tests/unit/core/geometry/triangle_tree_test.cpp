#include "core/geometry/triangle_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

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

}  // namespace
}  // namespace symcell
