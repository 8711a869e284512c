#include "core/plane/input/subdomains.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace symcell::plane {
namespace {

// Area and moment of a square of side 2 keep their digits whatever else there is far away.
TEST(Subdomains, FarVerticesCostNoDigits) {
  const Pslg square{{{3, 1}, {5, 1}, {5, 3}, {3, 3}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {}, {}};
  Pslg dangling = square;  // within the square and out of it
  dangling.vertices.insert(dangling.vertices.end(), {{4, 2}, {4.5, 7e9}});
  dangling.segments.insert(dangling.segments.end(), {{0, 4}, {2, 5}});
  Pslg other = square;
  for (const Point2 p : {Point2{1e9, 1e9}, Point2{1e9 + 1, 1e9}, Point2{1e9, 1e9 + 1}}) {
    other.vertices.push_back(p);
  }
  other.segments.insert(other.segments.end(), {{4, 5}, {5, 6}, {6, 4}});
  for (const Pslg& pslg : {square, dangling, other}) {
    ExecutionContext context;
    const auto found = make_subdomains(pslg, context);
    ASSERT_TRUE(found) << found.error().message;
    double area = 0;
    for (const Subdomain& face : found->faces) {
      if (face.area < 3) continue;
      area += face.area;
      const Point2 middle = found->reference + (1 / face.area) * face.moment;
      EXPECT_NEAR(middle.x, 4, 1e-15 * std::abs(found->reference.x) + 1e-14);
      EXPECT_NEAR(middle.y, 2, 1e-15 * std::abs(found->reference.y) + 1e-14);
    }
    EXPECT_DOUBLE_EQ(area, 4);
  }
}

}  // namespace
}  // namespace symcell::plane
