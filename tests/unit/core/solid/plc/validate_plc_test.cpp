#include "core/solid/plc/validate_plc.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/plc_builders.hpp"
#include "tests/support/plc_files.hpp"
#include "tests/support/test_files.hpp"

namespace symcell::solid {
namespace {

using test::add_box;
using test::box;

Result<ValidPlc> validate(const Plc& plc) {
  ExecutionContext context;
  return validate_plc(plc, context);
}

void expect_refused(const Plc& plc,
                    ErrorCode code,
                    const std::vector<std::string>& words,
                    const std::string& pointer = {}) {
  const auto result = validate(plc);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, code) << result.error().message;
  for (const std::string& word : words) {
    EXPECT_NE(result.error().message.find(word), std::string::npos) << result.error().message;
  }
  if (!pointer.empty()) {
    EXPECT_EQ(result.error().pointer, pointer);
  }
}

PlcFacet facet(std::vector<std::vector<std::int32_t>> polygons) {
  PlcFacet f;
  f.polygons = std::move(polygons);
  return f;
}

TEST(ValidatePlc, ABoxIsSound) {
  const auto valid = validate(box({0, 0, 0}, {1, 2, 3}));
  ASSERT_TRUE(valid) << valid.error().message;
  EXPECT_EQ(valid->complex.edges.size(), 12u);
  EXPECT_EQ(valid->cells.cells.size(), 2u);
  EXPECT_NEAR(valid->cells.volume, 6, 1e-14);
  EXPECT_TRUE(valid->cells.open_edges.empty());
}

TEST(ValidatePlc, NumbersAndIndices) {
  Plc plc = box({0, 0, 0}, {1, 1, 1});
  plc.vertices[3].y = std::numeric_limits<double>::quiet_NaN();
  expect_refused(plc, ErrorCode::kNonFinite, {"vertex 3"}, "/vertices/3");
  plc.vertices[3].y = 1e70;
  expect_refused(plc, ErrorCode::kCoordinateRange, {"vertex 3", "1e+70"}, "/vertices/3");

  plc = box({0, 0, 0}, {1, 1, 1});
  plc.facets[2].polygons[0][1] = 8;
  expect_refused(plc, ErrorCode::kIndexOutOfRange, {"facet 2", "vertex 8", "0 to 7"});
  plc.facets[2].polygons[0][1] = -1;
  expect_refused(plc, ErrorCode::kIndexOutOfRange, {"facet 2", "vertex -1"});

  plc = box({0, 0, 0}, {1, 1, 1});
  plc.holes.push_back({std::numeric_limits<double>::infinity(), 0, 0});
  expect_refused(plc, ErrorCode::kNonFinite, {"hole seed 0"}, "/holes/0");
  plc.holes.clear();
  plc.facets[1].holes.push_back({std::nan(""), 0, 0});
  expect_refused(plc, ErrorCode::kNonFinite, {"facet 1"}, "/facets/1/holes/0");

  plc = box({0, 0, 0}, {1, 1, 1});
  plc.segments.push_back({5, 5, 0});
  expect_refused(plc, ErrorCode::kZeroLengthSegment, {"segment 0", "vertex 5"}, "/segments/0");

  plc = box({0, 0, 0}, {1, 1, 1});
  plc.vertices.push_back(plc.vertices[2]);
  expect_refused(plc, ErrorCode::kDuplicateVertices, {"vertices 2 and 8"}, "/vertices/8");
  plc.vertices[8] = plc.vertices[2] + Point3{1e-14, 0, -1e-14};
  expect_refused(plc, ErrorCode::kDuplicateVertices, {"vertices 2 and 8"}, "/vertices/8");

  EXPECT_EQ(validate(Plc{}).error().code, ErrorCode::kDegenerateGeometry);
}

TEST(ValidatePlc, FacetsMustHaveAreaAndBePlanar) {
  Plc plc = box({0, 0, 0}, {1, 1, 1});
  plc.facets[0].polygons[0] = {0, 1};
  expect_refused(plc, ErrorCode::kDegenerateFacet, {"facet 0"}, "/facets/0");
  plc.facets[0].polygons.clear();
  expect_refused(plc, ErrorCode::kDegenerateFacet, {"facet 0"}, "/facets/0");

  plc = box({0, 0, 0}, {1, 1, 1});
  plc.vertices.push_back({0.5, 0, 0});
  plc.facets.push_back(facet({{0, 8, 1}}));
  expect_refused(plc, ErrorCode::kDegenerateFacet, {"facet 6", "one line"}, "/facets/6");

  plc = box({0, 0, 0}, {1, 1, 1});
  plc.vertices[7].z = 1.01;
  expect_refused(plc, ErrorCode::kNonplanarFacet, {"facet 1", "vertex", "off its plane"});
}

TEST(ValidatePlc, PolygonsMustNotCrossInTheirPlane) {
  Plc plc = box({0, 0, 0}, {1, 1, 1});
  plc.facets[0].polygons[0] = {0, 3, 2, 1};
  expect_refused(plc, ErrorCode::kSelfIntersection, {"facet 0"}, "/facets/0");
}

TEST(ValidatePlc, FacetsThatCrossAreNamedWithThePlace) {
  Plc plc = box({0, 0, 0}, {1, 1, 1});
  add_box(plc, {0.5, 0.25, 0.25}, {1.5, 0.75, 0.75});
  expect_refused(plc, ErrorCode::kSelfIntersection, {"facets 5 and ", "cross at (1, "});

  // A segment of no facet through a side.
  plc = box({0, 0, 0}, {1, 1, 1});
  plc.vertices.push_back({0.5, 0.375, 0.5});
  plc.vertices.push_back({1.5, 0.375, 0.5});
  plc.segments.push_back({8, 9, 0});
  expect_refused(plc, ErrorCode::kSelfIntersection, {"crosses facet 5 at (1, 0.375, 0.5)"});

  // Two such segments.
  plc = box({0, 0, 0}, {1, 1, 1});
  for (const Point3 p : {Point3{0.25, 0.5, 0.5}, Point3{0.75, 0.5, 0.5}, Point3{0.5, 0.25, 0.5},
                         Point3{0.5, 0.75, 0.5}}) {
    plc.vertices.push_back(p);
  }
  plc.segments.push_back({8, 9, 0});
  plc.segments.push_back({10, 11, 0});
  expect_refused(plc, ErrorCode::kSelfIntersection, {"vertex 8", "vertex 10"});
}

TEST(ValidatePlc, FacetsThatCrossBetweenCommonVerticesAreNamed) {
  // Two rhombs about one diagonal, which divides both into triangles.
  Plc plc = box({-2, -2, -2}, {2, 2, 3});
  for (const Point3 p : {Point3{0, 0, 0}, Point3{0, 0, 1}, Point3{1, 0, 0.5}, Point3{-1, 0, 0.5},
                         Point3{0, 1, 0.5}, Point3{0, -1, 0.5}}) {
    plc.vertices.push_back(p);
  }
  plc.facets.push_back(facet({{8, 10, 9, 11}}));
  plc.facets.push_back(facet({{8, 12, 9, 13}}));
  expect_refused(plc, ErrorCode::kSelfIntersection,
                 {"facets 6 and 7 cross between (0, 0, 0) and (0, 0, 1)"}, "/facets/7");
  // It may be a segment, of one of them: then it is of both.
  plc.facets.back().polygons.push_back({8, 9});
  ExecutionContext context;
  EXPECT_TRUE(validate_plc(plc, context));
}

TEST(ValidatePlc, OverlappingFacetsAreRefused) {
  // Two boxes side by side whose common walls only partly agree: coplanar, crossing edges.
  Plc plc = box({0, 0, 0}, {1, 1, 1});
  add_box(plc, {1, 0.5, 0.5}, {2, 1.5, 1.5});
  expect_refused(plc, ErrorCode::kSelfIntersection, {"facet"});
  // The same facet twice.
  plc = box({0, 0, 0}, {1, 1, 1});
  plc.facets.push_back(plc.facets[3]);
  expect_refused(plc, ErrorCode::kSelfIntersection, {"facets 3 and 6 overlap"});
}

TEST(ValidatePlc, WhatTouchesAFacetBecomesPartOfIt) {
  // A wall across the box that stands on its floor and leans on two sides, none of which has its
  // edges.
  Plc plc = box({0, 0, 0}, {1, 1, 1});
  for (const Point3 p :
       {Point3{0.3, 0, 0}, Point3{0.7, 1, 0}, Point3{0.7, 1, 1}, Point3{0.3, 0, 1}}) {
    plc.vertices.push_back(p);
  }
  plc.facets.push_back(facet({{8, 9, 10, 11}}));
  plc.regions.push_back({{0.1, 0.5, 0.5}, 1});
  plc.regions.push_back({{0.9, 0.5, 0.5}, 2});
  const auto valid = validate(plc);
  ASSERT_TRUE(valid) << valid.error().message;
  ASSERT_EQ(valid->cells.cells.size(), 3u);
  EXPECT_NEAR(valid->cells.cells[static_cast<std::size_t>(valid->cells.region_cell[0])].volume, 0.5,
              1e-14);
  EXPECT_NEAR(valid->cells.volume, 1, 1e-14);
}

TEST(ValidatePlc, DanglingFacetsAreFineButOpenModelsAreNot) {
  Plc plc = box({0, 0, 0}, {1, 1, 1});
  for (const Point3 p : {Point3{0.3, 0.3, 0.3}, Point3{0.7, 0.3, 0.3}, Point3{0.3, 0.7, 0.6}}) {
    plc.vertices.push_back(p);
  }
  plc.facets.push_back(facet({{8, 9, 10}}));
  const auto valid = validate(plc);
  ASSERT_TRUE(valid) << valid.error().message;
  EXPECT_EQ(valid->cells.cells.size(), 2u);
  EXPECT_EQ(valid->cells.open_edges.size(), 3u);
  EXPECT_NEAR(valid->cells.volume, 1, 1e-14);

  plc = box({0, 0, 0}, {1, 1, 1});
  plc.facets.erase(plc.facets.begin() + 1);
  expect_refused(plc, ErrorCode::kNotWatertight, {"open at the segment from vertex 4", "1 more"});
}

TEST(ValidatePlc, CellsAndSeeds) {
  // A box with a box in it, and in that a third.
  Plc plc = box({0, 0, 0}, {8, 8, 8});
  add_box(plc, {1, 1, 1}, {7, 7, 7});
  add_box(plc, {2, 2, 2}, {6, 6, 6});
  plc.holes.push_back({1.5, 1.5, 1.5});
  plc.regions.push_back({{4, 4, 4}, 5});
  auto valid = validate(plc);
  ASSERT_TRUE(valid) << valid.error().message;
  EXPECT_EQ(valid->cells.cells.size(), 4u);
  EXPECT_NEAR(valid->cells.volume, 512 - 216 + 64, 1e-10);

  plc.holes.push_back({9, 4, 4});
  expect_refused(plc, ErrorCode::kUnreachableSeed, {"hole seed 1", "(9, 4, 4)"}, "/holes/1");
  const auto& polygon = plc.facets[0].polygons[0];
  const auto corner = [&](std::size_t i) {
    return plc.vertices[static_cast<std::size_t>(polygon[i])];
  };
  // On a facet, on a side of it, at a corner.
  for (const Point3 p : {0.25 * (corner(0) + corner(1) + corner(2) + corner(3)),
                         0.5 * (corner(0) + corner(1)), corner(0)}) {
    plc.holes[1] = p;
    EXPECT_EQ(validate(plc).error().code, ErrorCode::kUnreachableSeed);
    EXPECT_NE(validate(plc).error().message.find("lies on facet"), std::string::npos);
  }
  plc.holes.pop_back();
  plc.regions.push_back({{1.5, 4, 4}, 2});
  expect_refused(plc, ErrorCode::kConflictingSeeds, {"hole seed 0", "region seed 1"}, "/regions/1");
  plc.regions.back() = {{4, 5, 5}, 6};
  expect_refused(plc, ErrorCode::kConflictingSeeds, {"region seed 0", "region seed 1"});
  plc.regions.back().attribute = 5;
  EXPECT_TRUE(validate(plc));
  plc.regions.clear();
  plc.holes = {{4, 4, 4}, {1.5, 4, 4}, {0.5, 4, 4}};
  expect_refused(plc, ErrorCode::kDegenerateGeometry, {"every cell has a hole seed"});
}

TEST(ValidatePlc, NeighbouringCellsShareAFacet) {
  // Two boxes that share a whole side, given once.
  Plc plc = box({0, 0, 0}, {1, 1, 1});
  const std::int32_t first = 8;
  for (const Point3 p : {Point3{3, 0, 0}, Point3{3, 1, 0}, Point3{3, 0, 1}, Point3{3, 1, 1}}) {
    plc.vertices.push_back(p);
  }
  plc.facets.push_back(facet({{1, first, first + 1, 3}}));
  plc.facets.push_back(facet({{5, first + 2, first + 3, 7}}));
  plc.facets.push_back(facet({{1, first, first + 2, 5}}));
  plc.facets.push_back(facet({{3, first + 1, first + 3, 7}}));
  plc.facets.push_back(facet({{first, first + 1, first + 3, first + 2}}));
  const auto valid = validate(plc);
  ASSERT_TRUE(valid) << valid.error().message;
  EXPECT_EQ(valid->cells.cells.size(), 3u);
  EXPECT_NEAR(valid->cells.volume, 3, 1e-14);
}

TEST(ValidatePlc, FacetsThatAreNotPlanarComeBeforeThoseWithoutArea) {
  Plc plc = test::read_plc_json(test::data_file("models/b33_plc_nonplanar_facets_n3.json"));
  expect_refused(plc, ErrorCode::kNonplanarFacet, {"facet 1", "vertex"});
  for (Point3& p : plc.vertices) p.z = std::min(p.z, 3.0);
  expect_refused(plc, ErrorCode::kDegenerateFacet, {"facet 0"});
}

}  // namespace
}  // namespace symcell::solid
