// The search for a good place of a vertex against a grid of places.
#include "core/plane/refine/feasible_region.hpp"

#include <algorithm>
#include <numbers>

#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

using test::Dice;

constexpr double kRadian = std::numbers::pi / 180;

struct Bounds {
  double alpha = 0;
  double max_edge = kInfinity;
};

bool keeps_bounds(const std::vector<StarEdge>& star, const Bounds& bounds, Point2 x) {
  for (const StarEdge& e : star) {
    const Point2 corner[3] = {e.a, e.b, x};
    const double doubled = cross(e.b - e.a, x - e.a);
    if (doubled <= 0 || doubled > 2 * e.max_area) return false;
    for (int i = 0; i < 3; ++i) {
      const Point2 u = corner[(i + 1) % 3] - corner[i], v = corner[(i + 2) % 3] - corner[i];
      if (std::atan2(cross(u, v), dot(u, v)) < bounds.alpha) return false;
    }
    if (std::max(distance(e.a, x), distance(e.b, x)) > bounds.max_edge) return false;
  }
  return true;
}

std::vector<StarEdge> random_star(Dice& dice, double max_area) {
  const std::size_t n = 3 + dice.below(6);
  std::vector<Point2> ring;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + dice.uniform(-0.3, 0.3)) /
                         static_cast<double>(n);
    const double radius = dice.uniform(0.6, 1.2);
    ring.push_back({5 + radius * std::cos(angle), -3 + radius * std::sin(angle)});
  }
  std::vector<StarEdge> star;
  for (std::size_t i = 0; i < n; ++i) star.push_back({ring[i], ring[(i + 1) % n], max_area});
  return star;
}

// A place with room: all bounds hold at it and at its neighbours on the grid.
std::optional<Point2> roomy_place(const std::vector<StarEdge>& star, const Bounds& bounds) {
  constexpr int kSteps = 48;
  constexpr double kStep = 2.4 / kSteps;
  std::vector<char> good;
  const auto at = [](int i, int j) { return Point2{3.8 + kStep * i, -4.2 + kStep * j}; };
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) good.push_back(keeps_bounds(star, bounds, at(i, j)));
  }
  const auto is_good = [&](int i, int j) {
    return good[static_cast<std::size_t>(i * (kSteps + 1) + j)] != 0;
  };
  for (int i = 1; i < kSteps; ++i) {
    for (int j = 1; j < kSteps; ++j) {
      bool all = true;
      for (int d = 0; d < 9 && all; ++d) all = is_good(i + d / 3 - 1, j + d % 3 - 1);
      if (all) return at(i, j);
    }
  }
  return std::nullopt;
}

TEST(FeasibleRegion, FindsAGoodPlaceExactlyWhereThereIsRoom) {
  Dice dice(3);
  int found = 0, none = 0;
  for (int i = 0; i < 1500; ++i) {
    Bounds bounds;
    bounds.alpha = dice.uniform(15, 38) * kRadian;
    if (i % 3 == 1) bounds.max_edge = dice.uniform(0.8, 1.4);
    const double max_area = i % 4 == 1 ? dice.uniform(0.2, 0.8) : kInfinity;
    const std::vector<StarEdge> star = random_star(dice, max_area);
    FeasibleRegion region(bounds.alpha, bounds.max_edge * bounds.max_edge);
    if (const auto x = region.find(star)) {
      ++found;
      EXPECT_TRUE(keeps_bounds(star, bounds, *x)) << "star " << i;
    } else {
      ++none;
      const auto place = roomy_place(star, bounds);
      EXPECT_FALSE(place) << "star " << i << ": (" << place->x << ", " << place->y << ") is good";
    }
  }
  EXPECT_GT(found, 200);
  EXPECT_GT(none, 200);
}

TEST(FeasibleRegion, OnALineTheMiddleOfTheGoodPart) {
  Dice dice(4);
  int found = 0, none = 0;
  for (int i = 0; i < 1500; ++i) {
    Bounds bounds;
    bounds.alpha = dice.uniform(15, 35) * kRadian;
    if (i % 3 == 1) bounds.max_edge = dice.uniform(0.7, 1.4);
    const std::vector<StarEdge> star = random_star(dice, i % 4 == 1 ? 0.5 : kInfinity);
    // From corner to corner, as a split of a subsegment: its own sides are no part of the star.
    const Point2 p{5 + dice.uniform(-0.5, 0.5), -4}, d{dice.uniform(-0.5, 0.5), 2};
    FeasibleRegion region(bounds.alpha, bounds.max_edge * bounds.max_edge);
    double first = 2, last = -1;
    constexpr int kSteps = 400;
    for (int s = 1; s < kSteps; ++s) {
      const double t = static_cast<double>(s) / kSteps;
      if (!keeps_bounds(star, bounds, p + t * d)) continue;
      first = std::min(first, t);
      last = t;
    }
    if (const auto x = region.find_on_line(star, p, d)) {
      ++found;
      EXPECT_TRUE(keeps_bounds(star, bounds, *x)) << "star " << i;
      if (last >= 0) {
        const double t = dot(*x - p, d) / squared_length(d);
        EXPECT_NEAR(t, 0.5 * (first + last), 2.0 / kSteps);
      }
    } else {
      ++none;
      EXPECT_LT(last - first, 2.0 / kSteps) << "star " << i;
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(none, 100);
}

TEST(FeasibleRegion, NoMoreTrianglesThanAnglesFit) {
  EXPECT_EQ(FeasibleRegion(30 * kRadian, kInfinity).most_edges(), 11U);
  EXPECT_EQ(FeasibleRegion(20 * kRadian - 1e-6, kInfinity).most_edges(), 18U);
}

}  // namespace
}  // namespace symcell::plane
