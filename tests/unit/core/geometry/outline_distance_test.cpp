#include "core/geometry/outline_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace symcell {
namespace {

TEST(OutlineDistance, IsThatOfTheFarthestPointNotOfTheEnds) {
  const std::vector<IndexedSegment> gap{{{0, 0}, {0, 1}}, {{4, 0}, {4, 1}}};
  const SegmentIndex index(gap);
  EXPECT_NEAR(outline_distance(index, {0, 0.5}, {4, 0.5}, 1e-9), 2, 1e-9);
  EXPECT_EQ(outline_distance(index, {0, 0.2}, {0, 0.8}, 1e-9), 0);
  EXPECT_NEAR(outline_distance(index, {0, 2}, {0, 3}, 1e-9), 2, 1e-12);
}

TEST(OutlineDistance, NothingIsInfinitelyFar) {
  const std::vector<IndexedSegment> none;
  EXPECT_TRUE(std::isinf(outline_distance(SegmentIndex(none), {0, 0}, {1, 0}, 1e-9)));
}

TEST(OutlineDistance, IsAtLeastThatOfEverySample) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] { return Point2{uniform(engine), uniform(engine)}; };
  for (int round = 0; round < 200; ++round) {
    std::vector<IndexedSegment> segments;
    for (int i = 0; i < 8; ++i) segments.push_back({point(), point()});
    const SegmentIndex index(segments);
    const Point2 a = point(), b = point();
    double sampled = 0;
    for (int i = 0; i <= 1000; ++i) {
      sampled = std::max(sampled, index.nearest(a + 0.001 * i * (b - a), 10).distance);
    }
    const double found = outline_distance(index, a, b, 1e-9);
    EXPECT_GE(found, sampled - 1e-9);
    EXPECT_LE(found, sampled + 0.002);
  }
}

}  // namespace
}  // namespace symcell
