// Loose ends that are joined, doubles and crossings that are mended, sectors that get their copies.
#include "core/plane/input/planar_input.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/geometry/arc.hpp"
#include "core/plane/input/subdomains.hpp"
#include "core/plane/input/validate_pslg.hpp"

namespace symcell::plane {
namespace {

Pslg prepared(const Pslg& pslg, const MeshOptions& options) {
  ExecutionContext context;
  const auto result = prepare_input(pslg, options, context);
  EXPECT_TRUE(result) << result.error().message;
  if (!result || !*result) return pslg;
  return (*result)->pslg;
}

void expect_valid(const Pslg& pslg) {
  ExecutionContext context;
  const auto valid = validate_pslg(pslg, context);
  EXPECT_TRUE(valid) << valid.error().message;
}

double area_of(const Pslg& pslg) {
  ExecutionContext context;
  const auto subdomains = make_subdomains(pslg, context);
  EXPECT_TRUE(subdomains);
  double area = 0;
  for (const Subdomain& face : subdomains->faces) area += face.meshed ? face.area : 0;
  return area;
}

// A triangle whose last vertex is the first one but for rounding.
Pslg open_triangle(double gap) {
  return {{{1, 0}, {-0.5, 0.75}, {-0.5, -0.75}, {1, -gap}}, {{0, 1}, {1, 2}, {2, 3}}, {}, {}};
}

TEST(PlanarInput, LooseEndsAreJoinedAndTold) {
  for (const double gap : {0.0, 1e-16, 1e-9}) {
    const Pslg result = prepared(open_triangle(gap), {});
    EXPECT_EQ(result.vertices.size(), 3U);
    EXPECT_EQ(result.notes.joined, 1U);
    EXPECT_EQ(result.notes.widest, gap);
    expect_valid(result);
    ASSERT_EQ(warnings_of(result.notes).size(), 1U);
    EXPECT_EQ(warnings_of(result.notes)[0].code, WarningCode::kLoopsJoined);
  }
}

TEST(PlanarInput, WhatIsAGapStaysOne) {
  EXPECT_EQ(prepared(open_triangle(1e-3), {}).vertices.size(), 4U);
  MeshOptions options;
  options.repair = Repair::kNone;
  EXPECT_EQ(prepared(open_triangle(1e-16), options).vertices.size(), 4U);
}

// Two overlapping squares, without a vertex where they cross, and a side given twice in parts.
TEST(PlanarInput, CrossingsAreSplitAndOverlapsMerged) {
  Pslg pslg{{{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {3, 1}, {3, 3}, {1, 3}, {0.5, 0}, {1.5, 0}},
            {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {8, 9, 7}},
            {},
            {}};
  MeshOptions options;
  options.repair = Repair::kAll;
  const Pslg result = prepared(pslg, options);
  expect_valid(result);
  EXPECT_EQ(result.vertices.size(), 12U);
  EXPECT_EQ(result.segments.size(), 14U);
  EXPECT_NEAR(area_of(result), 7, 1e-12);
  EXPECT_FALSE(result.notes.repairs.empty());
}

TEST(PlanarInput, DoublesAreJoinedOnRequest) {
  // Each side of a square with ends of its own.
  Pslg pslg;
  const Point2 corner[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::int32_t i = 0; i < 4; ++i) {
    pslg.vertices.push_back(corner[i]);
    pslg.vertices.push_back(corner[(i + 1) % 4] + Point2{1e-8, 0});
    pslg.segments.push_back({2 * i, 2 * i + 1, 0});
  }
  MeshOptions options;
  options.repair = Repair::kAll;
  const Pslg result = prepared(pslg, options);
  EXPECT_EQ(result.vertices.size(), 4U);
  expect_valid(result);
}

TEST(PlanarInput, ArcsAreSplitWhereTheyCross) {
  // Two circles through each other's centres.
  Pslg pslg{{{1, 0}, {-1, 0}, {2, 0}, {0, 0}}, {{0, 1}, {1, 0}, {2, 3}, {3, 2}}, {}, {}};
  pslg.bulges = {1, 1, 1, 1};
  MeshOptions options;
  options.repair = Repair::kAll;
  const Pslg result = prepared(pslg, options);
  EXPECT_EQ(result.vertices.size(), 6U);
  EXPECT_EQ(result.segments.size(), 8U);
  double turn = 0;
  for (const double bulge : result.bulges) turn += angle_of_bulge(bulge);
  EXPECT_NEAR(turn, 4 * std::numbers::pi, 1e-9);
}

// A quarter of a ring of two materials, from the angle 0 to 90 degrees.
Pslg quarter() {
  Pslg pslg{{{1, 0}, {2, 0}, {3, 0}, {0, 3}, {0, 2}, {0, 1}},
            {{0, 1, 9}, {1, 2, 9}, {2, 3, 1}, {3, 4, 9}, {4, 5, 9}, {5, 0, 2}, {1, 4, 3}},
            {},
            {{{1.1, 1.1}, 1, kInfinity}, {{1.8, 1.8}, 2, kInfinity}}};
  const double quarter_turn = std::tan(std::numbers::pi / 8);
  pslg.bulges = {0, 0, quarter_turn, 0, 0, -quarter_turn, quarter_turn};
  return pslg;
}

TEST(PlanarInput, SectorGetsItsCopiesAndLosesItsBounds) {
  MeshOptions options;
  options.sector = 4;
  ExecutionContext context;
  const auto input = prepare_input(quarter(), options, context);
  ASSERT_TRUE(input && *input) << input.error().message;
  const Pslg& whole = (*input)->pslg;
  EXPECT_EQ((*input)->options.fold, 4);
  EXPECT_EQ((*input)->options.center, (Point2{0, 0}));
  EXPECT_EQ(whole.vertices.size(), 12U);
  EXPECT_EQ(whole.segments.size(), 12U);
  for (const PslgSegment& s : whole.segments) EXPECT_NE(s.marker, 9);
  EXPECT_EQ(whole.regions.size(), 8U);
}

TEST(PlanarInput, BoundsOfDifferentMaterialsStay) {
  // The two halves of the quarter's outer material have attributes of their own.
  Pslg pslg = quarter();
  const double r = std::sqrt(0.5);
  pslg.vertices.push_back({2 * r, 2 * r});
  pslg.vertices.push_back({3 * r, 3 * r});
  pslg.segments.push_back({6, 7, 5});
  pslg.bulges.push_back(0);
  pslg.regions = {
      {{1.1, 1.1}, 1, kInfinity}, {{2.4, 0.3}, 2, kInfinity}, {{0.3, 2.4}, 3, kInfinity}};
  MeshOptions options;
  options.sector = 4;
  const Pslg whole = prepared(pslg, options);
  std::size_t kept = 0;
  for (const PslgSegment& s : whole.segments) kept += s.marker == 9 ? 1 : 0;
  EXPECT_EQ(kept, 4U);
}

TEST(PlanarInput, SectorsThatDoNotMeetAreRefused) {
  MeshOptions options;
  ExecutionContext context;
  options.sector = 5;
  auto wrong = prepare_input(quarter(), options, context);
  ASSERT_FALSE(wrong);
  options.sector = 3;  // gaps
  wrong = prepare_input(quarter(), options, context);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, ErrorCode::kNotSymmetric);
  EXPECT_EQ(wrong.error().pointer, "/options/sector");
}

// Coordinates with few digits: no step is left between the copies.
TEST(PlanarInput, SectorsThatAllButMeetAreRefusedWithTheToleranceThatTakesThem) {
  for (const double off : {1.5e-6, 5e-6, 4e-5}) {
    Pslg model = quarter();
    double largest = 0;
    for (const Point2 p : model.vertices) largest = std::max(largest, length(p));
    model.vertices[0].x += off * largest;
    MeshOptions options;
    options.sector = 4;
    ExecutionContext context;
    const auto refused = prepare_input(model, options, context);
    ASSERT_FALSE(refused) << off;
    EXPECT_EQ(refused.error().code, ErrorCode::kNotSymmetric);
    const std::string& message = refused.error().message;
    const std::size_t mend = message.find("symmetry_tolerance=");
    ASSERT_NE(mend, std::string::npos) << message;
    options.symmetry_tolerance_rel = std::stod(message.substr(mend + 19));
    EXPECT_LE(*options.symmetry_tolerance_rel, 2 * off);
    EXPECT_TRUE(prepare_input(model, options, context)) << message;
  }
}

}  // namespace
}  // namespace symcell::plane
