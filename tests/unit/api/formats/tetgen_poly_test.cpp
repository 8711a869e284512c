#include "api/formats/tetgen_poly.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace symcell {
namespace {

Result<Plc> poly(std::string_view text) {
  return read_tetgen(text, TetgenForm::kPoly);
}

Error error_of(std::string_view text, TetgenForm form = TetgenForm::kPoly) {
  const auto plc = read_tetgen(text, form);
  EXPECT_FALSE(plc.has_value()) << text;
  return plc ? Error{} : plc.error();
}

constexpr const char* kVertices =
    "# four corners\n4 3 1 1\n1 0 0 0 5.5 1\n2 1 0 0 5.5 1\n3 0 1 0 5.5 1\n4 0 0 1e0 5.5 1\n";

TEST(TetgenPoly, ReadsEverySection) {
  const auto plc = poly(std::string(kVertices) +
                        "3 1\n1 0 7   # one polygon, no holes, marker 7\n3 1 2 3\n"
                        "2 1 -2\n3  1 2\n 4\n2 3 4\n1 0.1 0.2 0.3\n"
                        "1\n3 2 3 4\n"
                        "1\n1 0.25 0.25 0.25\n"
                        "2\n1 0.1 0.1 0.1 3 0.5\n2 0 0 0 -4.0 -1\n");
  ASSERT_TRUE(plc) << plc.error().message;
  ASSERT_EQ(plc->vertices.size(), 4U);
  EXPECT_EQ(plc->vertices[3], (Point3{0, 0, 1}));
  ASSERT_EQ(plc->facets.size(), 3U);
  EXPECT_EQ(plc->facets[0], (PlcFacet{{{0, 1, 2}}, {}, 7}));
  EXPECT_EQ(plc->facets[1], (PlcFacet{{{0, 1, 3}, {2, 3}}, {{0.1, 0.2, 0.3}}, -2}));
  EXPECT_EQ(plc->facets[2], (PlcFacet{{{1, 2, 3}}, {}, 0}));
  EXPECT_EQ(plc->holes, std::vector<Point3>({{0.25, 0.25, 0.25}}));
  ASSERT_EQ(plc->regions.size(), 2U);
  EXPECT_EQ(plc->regions[0], (PlcRegion{{0.1, 0.1, 0.1}, 3, 0.5}));
  EXPECT_EQ(plc->regions[1].attribute, -4);
  EXPECT_TRUE(std::isinf(plc->regions[1].max_volume));
}

TEST(TetgenPoly, NumberingFromZeroAndNoRegions) {
  const auto plc = poly("3 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n1 0\n1 0 9\n3 0 1 2\n0\n");
  ASSERT_TRUE(plc) << plc.error().message;
  // Without the flag the facet's third number is no marker.
  EXPECT_EQ(plc->facets, std::vector<PlcFacet>({{{{0, 1, 2}}, {}, 0}}));
}

TEST(TetgenPoly, Smesh) {
  const auto plc = read_tetgen(std::string(kVertices) + "2 1\n3 1 2 3 7\n3 1 2\n4 8\n0\n0\n",
                               TetgenForm::kSmesh);
  ASSERT_TRUE(plc) << plc.error().message;
  ASSERT_EQ(plc->facets.size(), 2U);
  EXPECT_EQ(plc->facets[0], (PlcFacet{{{0, 1, 2}}, {}, 7}));
  EXPECT_EQ(plc->facets[1], (PlcFacet{{{0, 1, 3}}, {}, 8}));
}

TEST(TetgenPoly, WhatIsWrongIsTold) {
  const std::string head = kVertices;
  const std::pair<std::string, ErrorCode> cases[] = {
      {"0 3 0 0\n", ErrorCode::kMissingField},
      {"1 2 0 0\n1 0 0\n", ErrorCode::kUnsupportedModel},
      {"1 5 0 0\n1 0 0\n", ErrorCode::kSyntax},
      {"x 3\n", ErrorCode::kSyntax},
      {"2000000000 3 0 0\n1 0 0 0\n", ErrorCode::kCountMismatch},
      {"2 3 0 0\n1 0 0 0\n", ErrorCode::kTruncated},
      {"2 3 0 0\n1 0 0 0\n3 0 0 0\n", ErrorCode::kCountMismatch},
      {"1 3 0 0\n1 0 0\n", ErrorCode::kSyntax},
      {"1 3 0 0\n1 0 0 nan\n", ErrorCode::kNonFinite},
      {"1 3 0 0\n1 0 0 1e999\n", ErrorCode::kNonFinite},
      {head, ErrorCode::kTruncated},
      {head + "1 1\n", ErrorCode::kTruncated},
      {head + "1 1\nx\n", ErrorCode::kSyntax},
      {head + "1 1\n4000000000 0 1\n", ErrorCode::kCountMismatch},
      {head + "1 1\n1 0 1\n3 1    2\n", ErrorCode::kTruncated},
      {head + "1 1\n1 0 1\n900000000 1 2\n", ErrorCode::kCountMismatch},
      {head + "1 1\n1 0 1\n3 1 2 x\n0\n", ErrorCode::kSyntax},
      {head + "1 1\n1 0 1\n3 1 2 5000000000\n0\n", ErrorCode::kIndexOutOfRange},
      {head + "1 1\n1 0 1.5\n3 1 2 3\n0\n", ErrorCode::kSyntax},
      {head + "1 1\n1 1 1\n3 1 2 3\n", ErrorCode::kTruncated},
      {head + "1 1\n1 0 1\n3 1 2 3\n", ErrorCode::kTruncated},
      {head + "1 1\n1 0 1\n3 1 2 3\n0\n1\n1 0 0 0\n", ErrorCode::kSyntax},
      {head + "1 1\n1 0 1\n3 1 2 3\n0\n0\n7\n", ErrorCode::kCountMismatch}};
  for (const auto& [text, code] : cases) {
    const Error error = error_of(text);
    EXPECT_EQ(error.code, code) << text << ": " << error.message;
    EXPECT_TRUE(error.message.starts_with("line ")) << error.message;
  }
  EXPECT_EQ(error_of(head + "1 1\n1 0 1\n3 1 2 x\n0\n").pointer, "/facets/0/polygons/0/2");
  // Others are the validation's to refuse.
  EXPECT_TRUE(poly(head + "1 1\n1 0 1\n3 1 2 77\n0\n"));
}

TEST(TetgenPoly, DimensionOfAHeader) {
  EXPECT_EQ(poly_dimension("# x\n4 3 0 0\n"), 3);
  EXPECT_EQ(poly_dimension("4 2"), 2);
  for (const char* text : {"", "4", "4 5", "solid 3", "0.5 3"}) {
    EXPECT_FALSE(poly_dimension(text)) << text;
  }
}

}  // namespace
}  // namespace symcell
