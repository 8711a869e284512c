#include "api/formats/off.hpp"

#include <gtest/gtest.h>

namespace symcell {
namespace {

Error error_of(std::string_view bytes) {
  const auto surface = read_off(bytes);
  EXPECT_FALSE(surface.has_value()) << bytes;
  return surface ? Error{} : surface.error();
}

using Triangle = std::array<std::int32_t, 3>;

constexpr const char* kVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(Off, HeadersInTheirVariants) {
  const std::string body = std::string(kVertices) + "3 0 1 2\n3 0 2 3\n";
  for (const char* header :
       {"OFF\n4 2 5\n", "OFF 4 2 5\n", "OFF # cube\n# counts\n\n4 2\n", "4 2 0\n", "COFF\n4 2 0\n",
        "NOFF 4 2 0\n", "STCNOFF\n4 2 0\n", "off\r\n4 2 0\r\n"}) {
    const auto surface = read_off(header + body);
    ASSERT_TRUE(surface) << header << surface.error().message;
    EXPECT_EQ(surface->vertices[2], (Point3{1, 1, 0}));
    EXPECT_EQ(surface->triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(surface->source_face.empty());
  }
}

TEST(Off, ColoursAndNormalsAreReadOver) {
  const auto surface = read_off(
      "CNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 0 255 0\n0 1 0 0 0 1 0 0 255 128\n"
      "3 0 1 2 0.5 0.5 0.5\n");
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->vertices[1], (Point3{1, 0, 0}));
}

TEST(Off, PolygonsNameTheirFace) {
  const auto surface =
      read_off("OFF\n5 2 0\n" + std::string(kVertices) + "0.5 0.5 1\n4 0 1 2 3\n3 4 0 1\n");
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->triangles.size(), 3U);
  EXPECT_EQ(surface->source_face, (std::vector<std::int32_t>{0, 0, 1}));
}

TEST(Off, WhatIsWrongIsTold) {
  const std::string head = "OFF\n4 1 0\n" + std::string(kVertices);
  const std::pair<std::string, ErrorCode> cases[] = {
      {"OFF", ErrorCode::kTruncated},
      {"OFF\n1 x 0\n0 0 0\n", ErrorCode::kSyntax},
      {"OFF\n4000000000 1 0\n0 0 0\n", ErrorCode::kCountMismatch},
      {"OFF\n4 2 0\n" + std::string(kVertices) + "3 0 1 2\n", ErrorCode::kTruncated},
      {"OFF BINARY\n", ErrorCode::kUnsupportedModel},
      {"4OFF\n", ErrorCode::kUnsupportedModel},
      {"OFF\n1 0 0\n0 0 nan\n", ErrorCode::kNonFinite},
      {"OFF\n1 0 0\n0 0 1e999\n", ErrorCode::kNonFinite},
      {"OFF\n1 0 0\n0 0\n", ErrorCode::kSyntax},
      {"OFF\n1 0 0\n0 zero 0\n", ErrorCode::kSyntax},
      {head + "3 0 1 4\n", ErrorCode::kIndexOutOfRange},
      {head + "3 0 1 -1\n", ErrorCode::kIndexOutOfRange},
      {head + "3 0 1 # 2\n", ErrorCode::kSyntax},
      {head + "2 0 1\n", ErrorCode::kDegenerateFacet},
      {head + "4 0 1 2 0\n", ErrorCode::kDegenerateFacet},
      {head + "3 0 1 2\n3 0 2 3\n", ErrorCode::kCountMismatch},
      {"OFF\n4 0 0\n" + std::string(kVertices), ErrorCode::kDegenerateGeometry}};
  for (const auto& [text, code] : cases) {
    const Error error = error_of(text);
    EXPECT_EQ(error.code, code) << text << ": " << error.message;
  }
  const Error error = error_of(head + "3 0 1 4\n");
  EXPECT_NE(error.message.find("line 7"), std::string::npos) << error.message;
  EXPECT_EQ(error.elements, std::vector<std::int64_t>{0});
}

}  // namespace
}  // namespace symcell
