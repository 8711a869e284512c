#include "api/formats/stl.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace symcell {
namespace {

Error error_of(std::string_view bytes) {
  const auto surface = read_stl(bytes);
  EXPECT_FALSE(surface.has_value());
  return surface ? Error{} : surface.error();
}

std::string facet(const std::string& third = "0 1 0", const std::string& normal = "0 0 1") {
  return "facet normal " + normal + "\n outer loop\n  vertex 0 0 0\n  vertex 1e0 0 0\n  vertex " +
         third + "\n endloop\nendfacet\n";
}

void append_u32(std::string& bytes, std::uint32_t value) {
  for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffU);
}

// Triangles (0,0,0), (1,0,0), (0,1,z).
std::string binary(std::uint32_t told, const std::vector<float>& heights, std::string head = "") {
  head.resize(80, '\0');
  append_u32(head, told);
  for (const float z : heights) {
    for (const float c : {0.F, 0.F, 0.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, z}) {
      append_u32(head, std::bit_cast<std::uint32_t>(c));
    }
    head += std::string(2, '\x7f');
  }
  return head;
}

TEST(Stl, AsciiInItsVariants) {
  const auto surface = read_stl("solid two words\n" + facet() + "endsolid two words\n\n" +
                                "SOLID\r\n\tFACET NORMAL 0 0 1 OUTER LOOP VERTEX -1.5E+1 0 0 "
                                "vertex 1 0 0 vertex 0 1 0 ENDLOOP ENDFACET\nEndSolid");
  ASSERT_TRUE(surface) << surface.error().message;
  ASSERT_EQ(surface->triangles.size(), 2U);
  EXPECT_EQ(surface->vertices.size(), 6U);
  EXPECT_EQ(surface->vertices[1], (Point3{1, 0, 0}));
  EXPECT_EQ(surface->vertices[3], (Point3{-15, 0, 0}));
  EXPECT_EQ(surface->triangles[1], (std::array<std::int32_t, 3>{3, 4, 5}));
  EXPECT_TRUE(surface->source_face.empty());
}

TEST(Stl, NormalsAreNotLookedAt) {
  for (const char* normal : {"0 0 0", "nan nan nan", "-nan(ind) 1 0", "", "x"}) {
    EXPECT_TRUE(read_stl("solid\n" + facet("0 1 0", normal) + "endsolid")) << normal;
  }
}

TEST(Stl, AsciiErrorsNameTheLineAndTheTriangle) {
  const std::string good = "solid a\n" + facet();
  const Error cut = error_of(good + "facet normal 0 0 1\nouter loop\nvertex 0 0");
  EXPECT_EQ(cut.code, ErrorCode::kTruncated);
  EXPECT_EQ(cut.elements, std::vector<std::int64_t>{1});
  EXPECT_EQ(error_of(good).code, ErrorCode::kTruncated);
  const Error word = error_of("solid a\n" + facet("0 one 0") + "endsolid");
  EXPECT_EQ(word.code, ErrorCode::kSyntax);
  EXPECT_NE(word.message.find("line 6"), std::string::npos) << word.message;
  for (const char* number : {"nan", "-inf", "1e999"}) {
    const Error error = error_of("solid a\n" + facet(std::string("0 1 ") + number) + "endsolid");
    EXPECT_EQ(error.code, ErrorCode::kNonFinite);
    EXPECT_EQ(error.elements, std::vector<std::int64_t>{0});
  }
  EXPECT_EQ(error_of("solid a\nsolid b\n").code, ErrorCode::kSyntax);
  EXPECT_EQ(error_of("solid a\n facet normal 0 0 1\n vertex 0 0 0\n vertex 1 1 1\n").code,
            ErrorCode::kSyntax);
  EXPECT_EQ(error_of("solid a\nendsolid a\n").code, ErrorCode::kDegenerateGeometry);
  EXPECT_EQ(error_of("squid a\n").code, ErrorCode::kUnknownFormat);
}

TEST(Stl, BinaryWhateverItsHeadSays) {
  for (const char* head : {"", "solid part", "COLOR=abcd", "solid facet normal"}) {
    const auto surface = read_stl(binary(2, {0, 0.5F}, head));
    ASSERT_TRUE(surface) << surface.error().message;
    EXPECT_EQ(surface->triangles.size(), 2U);
    EXPECT_EQ(surface->vertices[5], (Point3{0, 1, 0.5}));
  }
  std::string spaces(80, ' ');
  EXPECT_TRUE(read_stl(binary(1, {0}, spaces)));
}

TEST(Stl, BinaryCountsAreNotBelieved) {
  const std::string two = binary(2, {0, 1});
  EXPECT_EQ(error_of(two.substr(0, 40)).code, ErrorCode::kTruncated);
  EXPECT_EQ(error_of(two.substr(0, two.size() - 1)).code, ErrorCode::kTruncated);
  EXPECT_EQ(error_of(binary(3, {0, 1})).code, ErrorCode::kCountMismatch);
  EXPECT_EQ(error_of(binary(4294967295U, {0, 1})).code, ErrorCode::kCountMismatch);
  EXPECT_EQ(error_of(binary(1, {0, 1})).code, ErrorCode::kCountMismatch);
  EXPECT_EQ(error_of(binary(0, {})).code, ErrorCode::kDegenerateGeometry);
  // Padding is borne.
  EXPECT_TRUE(read_stl(two + "\r\n"));
  EXPECT_TRUE(read_stl(two + std::string(400, '\0')));
}

TEST(Stl, BinaryNumbersThatAreNotFinite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const Error error = error_of(binary(3, {0, bad, 0}));
    EXPECT_EQ(error.code, ErrorCode::kNonFinite);
    EXPECT_EQ(error.elements, std::vector<std::int64_t>{1});
    EXPECT_EQ(error.pointer, "/triangles/1");
    EXPECT_NE(error.message.find("triangle 1"), std::string::npos);
  }
}

TEST(Stl, BinaryIsToldFromForeignBytes) {
  EXPECT_TRUE(looks_like_binary_stl(binary(1, {0})));
  EXPECT_TRUE(looks_like_binary_stl(binary(7, {0, 1}, "exported")));
  EXPECT_FALSE(looks_like_binary_stl("solid a\n" + facet() + facet() + "endsolid"));
  std::string program =
      "\x7f"
      "ELF\2\1\1";
  program.resize(300, '\3');
  EXPECT_FALSE(looks_like_binary_stl(program));
  EXPECT_FALSE(looks_like_binary_stl(std::string(300, '\xff')));
}

}  // namespace
}  // namespace symcell
