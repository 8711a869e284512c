#include "api/formats/fem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/geometry/arc.hpp"

namespace symcell {
namespace {

constexpr const char* kHead =
    "[Format]      =  4.0\n[Frequency]   =  0\n[Precision]   =  1e-008\n[MinAngle]    =  30\n"
    "[LengthUnits] =  millimeters\n[BdryProps]  = 1\n  <BeginBdry>\n"
    "    <BdryName> = \"A=0\"\n    <BdryType> = 0\n  <EndBdry>\n[BlockProps]  = 0\n";

std::string half_disc(const std::string& labels = "[NumBlockLabels] = 1\n0 0.5 2 0.1 0 0 7 1 0\n") {
  return std::string(kHead) + "[NumPoints] = 2\n-1\t0\t0\t0\n1\t0\t0\t0\n" +
         "[NumSegments] = 1\n0\t1\t-1\t1\t0\t0\n" +
         "[NumArcSegments] = 1\n1\t0\t180\t10\t1\t0\t0\t10\n" + "[NumHoles] = 1\n0 3 0\n" + labels;
}

TEST(Fem, EverythingThatMatters) {
  const auto model = read_fem(half_disc());
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->vertices.size(), 2U);
  ASSERT_EQ(model->segments.size(), 2U);
  EXPECT_EQ(model->segments[0], (PslgSegment{0, 1, 1}));
  EXPECT_NEAR(model->bulge(1), 1, 1e-12);
  EXPECT_NEAR(model->chord_angle(1), std::numbers::pi / 18, 1e-12);
  EXPECT_EQ(model->holes.size(), 1U);
  ASSERT_EQ(model->regions.size(), 1U);
  EXPECT_EQ(model->regions[0].attribute, 7);
  EXPECT_NEAR(model->regions[0].max_area, std::numbers::pi / 4 * 0.01, 1e-12);
  EXPECT_EQ(model->marker_names, (std::vector<MarkerName>{{1, "A=0"}}));
}

TEST(Fem, MaterialStandsForTheGroupWhereNoneHasOne) {
  const auto model = read_fem(half_disc("[NumBlockLabels] = 1\n0 0.5 2 -1 0 0 0 1 0\n"));
  ASSERT_TRUE(model);
  EXPECT_EQ(model->regions[0].attribute, 2);
  EXPECT_TRUE(std::isinf(model->regions[0].max_area));
}

void expect_error(const std::string& text, ErrorCode code, const std::string& part) {
  const auto model = read_fem(text);
  ASSERT_FALSE(model);
  EXPECT_EQ(error_code_name(model.error().code), error_code_name(code)) << model.error().message;
  EXPECT_NE(model.error().message.find(part), std::string::npos) << model.error().message;
}

TEST(Fem, NamesWhatIsWrong) {
  const std::string head = kHead;
  expect_error(head, ErrorCode::kTruncated, "[NumPoints]");
  expect_error(head + "[NumPoints] = 3\n0 0 0 0\n", ErrorCode::kTruncated, "point 1 of 3");
  expect_error(head + "[NumPoints] = 2000000000\n0 0 0 0\n", ErrorCode::kTooLarge, "points");
  expect_error(head + "[NumPoints] = -1\n", ErrorCode::kSyntax, "-1");
  expect_error(head + "[NumPoints] = 1\nnan 0 0 0\n", ErrorCode::kNonFinite, "point 0");
  expect_error(head + "[NumPoints] = 2\n0 0 0 0\n[NumSegments] = 0\n", ErrorCode::kCountMismatch,
               "point 1");
  expect_error(head + "[NumPoints] = 2\n0 0 0 0\n1 0 0 0\n[NumSegments] = 1\n0 2 -1 0 0 0\n",
               ErrorCode::kIndexOutOfRange, "no point 2");
  expect_error(head + "[NumPoints] = 2\n0 0\n1 0\n[NumArcSegments] = 1\n0 1 400 5 0 0 0\n",
               ErrorCode::kSyntax, "400");
}

}  // namespace
}  // namespace symcell
