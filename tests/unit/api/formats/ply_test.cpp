#include "api/formats/ply.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace symcell {
namespace {

using Triangle = std::array<std::int32_t, 3>;

Error error_of(std::string_view bytes) {
  const auto surface = read_ply(bytes);
  EXPECT_FALSE(surface.has_value()) << bytes;
  return surface ? Error{} : surface.error();
}

// Writes numbers in either byte order.
class Bytes {
 public:
  explicit Bytes(bool big) : big_(big) {}
  template <class T>
  Bytes& add(T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    const bool turn = big_ != (std::endian::native == std::endian::big);
    if (turn) std::reverse(std::begin(raw), std::end(raw));
    text.append(raw, sizeof value);
    return *this;
  }
  std::string text;

 private:
  bool big_;
};

constexpr const char* kAsciiHead =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
    "end_header\n";
constexpr const char* kAsciiVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(Ply, Ascii) {
  const auto surface = read_ply(std::string(kAsciiHead) + kAsciiVertices + "4 0 1 2 3\n");
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->vertices[2], (Point3{1, 1, 0}));
  EXPECT_EQ(surface->triangles.size(), 2U);
  EXPECT_EQ(surface->source_face, (std::vector<std::int32_t>{0, 0}));
}

TEST(Ply, BinaryOfBothOrdersWithForeignProperties) {
  for (const bool big : {false, true}) {
    const std::string head =
        std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\r\nelement camera 1\r\nproperty list ushort double view\r\n"
        "element vertex 3\r\nproperty uchar red\r\nproperty double z\r\n"
        "property float x\r\nproperty short y\r\nelement face 1\r\n"
        "property int label\r\nproperty list uint16 uint vertex_index\r\n"
        "element empty 99999999999\r\nend_header\r\n";
    Bytes body(big);
    body.add<std::uint16_t>(2).add(1.5).add(2.5);
    body.add<std::uint8_t>(7).add(0.25).add(1.5F).add<std::int16_t>(-3);
    body.add<std::uint8_t>(7).add(0.0).add(0.0F).add<std::int16_t>(0);
    body.add<std::uint8_t>(7).add(0.0).add(1.0F).add<std::int16_t>(0);
    body.add<std::int32_t>(-1).add<std::uint16_t>(3);
    body.add<std::uint32_t>(2).add<std::uint32_t>(1).add<std::uint32_t>(0);
    const auto surface = read_ply(head + body.text);
    ASSERT_TRUE(surface) << surface.error().message;
    EXPECT_EQ(surface->vertices[0], (Point3{1.5, -3, 0.25}));
    EXPECT_EQ(surface->triangles, std::vector<Triangle>({{2, 1, 0}}));
    EXPECT_EQ(error_of(head + body.text.substr(0, body.text.size() - 1)).code,
              ErrorCode::kTruncated);
    EXPECT_EQ(error_of(head + body.text + "more").code, ErrorCode::kCountMismatch);
  }
}

TEST(Ply, FacesMayComeFirst) {
  const auto surface = read_ply(
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
      "3 0 1 2\n0 0 0 1 0 0\n0 1 0\n");
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->triangles.size(), 1U);
}

TEST(Ply, WhatIsWrongIsTold) {
  const std::string head = kAsciiHead;
  const std::string good = head + kAsciiVertices;
  const auto header = [](const std::string& lines) {
    return "ply\nformat ascii 1.0\n" + lines + "end_header\n";
  };
  const std::string no_x = "element vertex 1\nproperty float y\nproperty float z\n";
  const std::pair<std::string, ErrorCode> cases[] = {
      {"ply\n", ErrorCode::kTruncated},
      {"ply\nend_header\n", ErrorCode::kSyntax},
      {"ply\nformat ebcdic 1.0\nend_header\n", ErrorCode::kUnsupportedModel},
      {header("nonsense\n"), ErrorCode::kSyntax},
      {header("property float x\n"), ErrorCode::kSyntax},
      {header("element vertex -1\n"), ErrorCode::kSyntax},
      {header("element vertex 1\nproperty quad x\n"), ErrorCode::kSyntax},
      {header("element vertex 1\nproperty list float int x\n"), ErrorCode::kSyntax},
      {header("element tristrips 1\nproperty list int int vertex_indices\n"),
       ErrorCode::kUnsupportedModel},
      {header(""), ErrorCode::kMissingField},
      {header(no_x) + "1 1\n", ErrorCode::kMissingField},
      {header("element face 1\nproperty int a\n") + "1\n", ErrorCode::kMissingField},
      {good, ErrorCode::kTruncated},
      {head + "0 0 0\n1 0 x\n", ErrorCode::kSyntax},
      {head + "0 0 0\n1 0 nan\n", ErrorCode::kNonFinite},
      {head + "0 0 0\n1 0 1e999\n", ErrorCode::kNonFinite},
      {good + "3 0 1 4\n", ErrorCode::kIndexOutOfRange},
      {good + "3 0 1 0.5\n", ErrorCode::kSyntax},
      {good + "2 0 1\n", ErrorCode::kDegenerateFacet},
      {good + "-3 0 1 2\n", ErrorCode::kSyntax},
      {good + "3 0 1 2\n3 0 2 3\n", ErrorCode::kCountMismatch}};
  for (const auto& [text, code] : cases) {
    const Error error = error_of(text);
    EXPECT_EQ(error.code, code) << text << ": " << error.message;
  }
  // Nothing is set aside for what a header promises.
  std::string huge = head;
  huge.replace(huge.find("vertex 4"), 8, "vertex 9000000000000000000");
  EXPECT_EQ(error_of(huge + "0 0 0\n").code, ErrorCode::kTruncated);
}

TEST(Ply, NumbersThatAreNotFinite) {
  Bytes body(false);
  body.add(0.0F).add(std::numeric_limits<float>::quiet_NaN()).add(0.0F);
  const Error error = error_of(
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n" +
      body.text);
  EXPECT_EQ(error.code, ErrorCode::kNonFinite);
  EXPECT_EQ(error.elements, std::vector<std::int64_t>{0});
}

}  // namespace
}  // namespace symcell
