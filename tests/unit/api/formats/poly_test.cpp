#include "api/formats/poly.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace symcell {
namespace {

ErrorCode code_of(std::string_view text) {
  const auto model = read_poly(text);
  EXPECT_FALSE(model.has_value()) << text;
  return model ? ErrorCode::kInternal : model.error().code;
}

TEST(Poly, NumberedFromOneWithEverything) {
  const auto model = read_poly(
      "# a square with a hole\n"
      "4 2 1 1   # vertices, dimension, attributes, markers\n"
      "1  0 0  7.5 1\n2 +1 0 7.5 1\r\n\n3 1 1 7.5 1\n4 0 1e0 7.5 1\n"
      "4 1\n1 1 2 11\n2 2 3 12\n3 3 4 13\n4 4 1 -14\n"
      "1\n1 0.5 0.5\n"
      "2\n1 0.1 0.1 2.0 -1\n2 0.9 0.9 3 0.25\n");
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->vertices.size(), 4U);
  EXPECT_EQ(model->vertices[2], (Point2{1, 1}));
  EXPECT_EQ(model->segments[3], (PslgSegment{3, 0, -14}));
  EXPECT_EQ(model->holes[0], (Point2{0.5, 0.5}));
  EXPECT_EQ(model->regions[0].attribute, 2);
  EXPECT_TRUE(std::isinf(model->regions[0].max_area));
  EXPECT_EQ(model->regions[1].max_area, 0.25);
}

TEST(Poly, NumberedFromZeroAndHolesAsTheyLike) {
  const auto model =
      read_poly("3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n3 0\n1 0 1\n2 1 2\n3 2 0\n1\n1 0.2 0.2");
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->segments[0], (PslgSegment{0, 1, 0}));
  EXPECT_EQ(model->holes.size(), 1U);
}

TEST(Poly, HeadersThatLie) {
  EXPECT_EQ(code_of("999999999999 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n"),
            ErrorCode::kCountMismatch);
  EXPECT_EQ(code_of("4 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n"),
            ErrorCode::kCountMismatch);
  EXPECT_EQ(code_of("2 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n"),
            ErrorCode::kCountMismatch);
  EXPECT_EQ(code_of("3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n0\n1 2 3\n"),
            ErrorCode::kCountMismatch);
}

TEST(Poly, FilesThatEndTooEarly) {
  const std::string whole = "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n";
  ASSERT_TRUE(read_poly(whole));
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
    EXPECT_FALSE(read_poly(whole.substr(0, size))) << size;
  }
  EXPECT_EQ(code_of("3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n"),
            ErrorCode::kTruncated);
}

TEST(Poly, MessagesNameTheLine) {
  const auto model = read_poly("3 2 0 0\n1 0 0\n# comment\n2 1 oops\n3 0 1\n");
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kSyntax);
  EXPECT_EQ(model.error().message, "line 4: \"oops\" is no number");
  EXPECT_EQ(model.error().pointer, "/vertices/1/1");
}

TEST(Poly, OtherFaults) {
  EXPECT_EQ(code_of("0 2 0 0\n3 0\n"), ErrorCode::kMissingField);
  EXPECT_EQ(code_of("1 3 0 0\n1 0 0 0\n"), ErrorCode::kUnsupportedModel);
  EXPECT_EQ(code_of("1 7 0 0\n1 0 0 0\n"), ErrorCode::kSyntax);
  EXPECT_EQ(code_of("-4 2 0 0\n"), ErrorCode::kSyntax);
  EXPECT_EQ(code_of("3 2 0 0\n1 0 1e999\n2 1 0\n3 0 1\n"), ErrorCode::kNonFinite);
  EXPECT_EQ(code_of("3 2 0 0\n1 0 nan\n2 1 0\n3 0 1\n"), ErrorCode::kNonFinite);
  EXPECT_EQ(code_of("1 2 0 0\n1 0 0\n1 0\n1 1 99999999999\n0\n"), ErrorCode::kIndexOutOfRange);
  EXPECT_EQ(code_of("1 2 0 0\n1 0 0\n1 1\n1 1 1 2.5\n0\n"), ErrorCode::kSyntax);
  EXPECT_EQ(code_of("1 2 0 0\n1 0\n"), ErrorCode::kSyntax);
}

// Indices out of range are validate_pslg's to refuse, with all of its words.
TEST(Poly, IndicesAreNotChecked) {
  const auto model = read_poly("1 2 0 0\n1 0 0\n1 0\n1 1 9\n0\n");
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->segments[0].b, 8);
}

}  // namespace
}  // namespace symcell
