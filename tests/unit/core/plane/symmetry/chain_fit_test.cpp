// One polyline of several that run along each other.
#include "core/plane/symmetry/chain_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace symcell::plane {
namespace {

using Line = std::vector<Point2>;

Result<FittedChain> fit(const std::vector<Line>& copies, double tolerance) {
  ExecutionContext context;
  return fit_chain(copies, {copies.front().front(), copies.front().back(), tolerance, 1e-12},
                   context);
}

// A quarter of the unit circle, cut at `phase` and every `step` from there.
Line arc(double phase, double step) {
  Line line{{1, 0}};
  for (double t = phase; t < std::numbers::pi / 2 - 1e-9; t += step) {
    if (t > 0) line.push_back({std::cos(t), std::sin(t)});
  }
  line.push_back({0, 1});
  return line;
}

TEST(ChainFit, WhatAllCopiesHaveStaysAtItsMean) {
  const std::vector<Line> copies{{{0, 0}, {1, 0.001}, {2, 0}}, {{0, 0}, {1, -0.001}, {2, 0}}};
  const auto fitted = fit(copies, 0.01);
  ASSERT_TRUE(fitted);
  ASSERT_EQ(fitted->points.size(), 1U);
  EXPECT_NEAR(fitted->points[0].x, 1, 1e-12);
  EXPECT_NEAR(fitted->points[0].y, 0, 1e-12);
  EXPECT_EQ(fitted->shared, 1U);
}

TEST(ChainFit, LeftOversOnStraightPartsGo) {
  const std::vector<Line> copies{{{0, 0}, {0.3, 0}, {1, 0}, {2, 1}},
                                 {{0, 0}, {1, 0}, {1.2, 0.2}, {1.9, 0.9}, {2, 1}},
                                 {{0, 0}, {1, 0}, {2, 1}}};
  const auto fitted = fit(copies, 1e-6);
  ASSERT_TRUE(fitted);
  EXPECT_EQ(fitted->points, (Line{{1, 0}}));
}

TEST(ChainFit, ArcsOutOfPhaseGetAsManyEvenEdgesAsTheyHad) {
  const double step = 0.1;
  std::vector<Line> copies;
  for (int i = 0; i < 5; ++i) copies.push_back(arc(step * (0.2 * i + 0.01), step));
  const auto fitted = fit(copies, 0.01);
  ASSERT_TRUE(fitted);
  Line line = fitted->points;
  EXPECT_GE(line.size(), 13U);  // 15.7 edges before
  EXPECT_LE(line.size(), 16U);
  line.insert(line.begin(), {1, 0});
  line.push_back({0, 1});
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    EXPECT_GE(distance(line[i], line[i + 1]), 0.6 * step);
    EXPECT_LE(distance(line[i], line[i + 1]), 1.5 * step);
  }
}

TEST(ChainFit, FeaturesOfEveryCopyStayHoweverSmall) {
  // A notch smaller than the asymmetry of the arc beside it.
  std::vector<Line> copies;
  for (const double phase : {0.0, 0.1}) {
    Line line{{0, 0}, {1, 0}, {1.001, 0.001}, {1.002, 0}, {2, 0}};
    for (double t = phase; t < 1; t += 0.2) {
      if (t > 0) line.push_back({2 + std::sin(t), 1 - std::cos(t)});
    }
    line.push_back({2 + std::sin(1.0), 1 - std::cos(1.0)});
    copies.push_back(line);
  }
  const auto fitted = fit(copies, 0.05);
  ASSERT_TRUE(fitted);
  for (const Point2 corner : {Point2{1, 0}, Point2{1.001, 0.001}, Point2{1.002, 0}}) {
    EXPECT_TRUE(std::count(fitted->points.begin(), fitted->points.end(), corner) == 1);
  }
}

TEST(ChainFit, LinesThatRunApartAreRefused) {
  const auto fitted = fit({{{0, 0}, {1, 0.5}, {2, 0}}, {{0, 0}, {2, 0}}}, 0.01);
  ASSERT_FALSE(fitted);
  EXPECT_EQ(fitted.error().code, ErrorCode::kNotSymmetric);
}

TEST(PlacesAlong, KeepTheOrderAtAHairpin) {
  const Line line{{0, 0}, {1, 0}, {1, 0.01}, {0, 0.01}};
  const std::vector<double> places =
      places_along(line, Line{{0, 0}, {0.5, 0}, {1, 0}, {0.5, 0.01}, {0, 0.01}}, 1e-3);
  ASSERT_EQ(places.size(), 5U);
  EXPECT_NEAR(places[1], 0.5, 1e-9);
  EXPECT_NEAR(places[3], 1.51, 1e-9);
  EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
}

}  // namespace
}  // namespace symcell::plane
