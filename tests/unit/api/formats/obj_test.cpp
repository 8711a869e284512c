#include "api/formats/obj.hpp"

#include <gtest/gtest.h>

namespace symcell {
namespace {

Error error_of(std::string_view bytes) {
  const auto surface = read_obj(bytes);
  EXPECT_FALSE(surface.has_value()) << bytes;
  return surface ? Error{} : surface.error();
}

using Triangle = std::array<std::int32_t, 3>;

constexpr const char* kVertices = "v 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, CornersInAllForms) {
  const auto surface = read_obj("# a comment\nmtllib x.mtl\no part\n" + std::string(kVertices) +
                                "vt 0 0\nvn 0 0 1\ng left\ns off\nusemtl red\n"
                                "f 1 2 3\nf 1/1 2/1 3/1\nf 1//1 3//1 4//1\nf 1/1/1 3/1/1 4/1/1\n"
                                "f -4 -3 -2\nl 1 2\np 1\nf 1 2 \\\n 4\nf 1\\\n2 \\\n\\\n3\n");
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->vertices.size(), 4U);
  EXPECT_EQ(surface->vertices[1], (Point3{1, 0, 0}));
  EXPECT_EQ(surface->triangles,
            (std::vector<Triangle>{
                {0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {0, 2, 3}, {0, 1, 2}, {0, 1, 3}, {0, 1, 2}}));
}

TEST(Obj, NegativeCornersCountFromTheLine) {
  const auto surface = read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 5\nf -1 -2 -3\n");
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 2, 1}}));
}

TEST(Obj, PolygonsNameTheirFace) {
  const auto surface = read_obj(std::string(kVertices) + "f 1 2 3 4\nf 1 3 4\n");
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->source_face, (std::vector<std::int32_t>{0, 0, 1}));
}

TEST(Obj, WhatIsWrongIsTold) {
  const std::pair<std::string, ErrorCode> cases[] = {
      {"v 0 0\n", ErrorCode::kSyntax},
      {"v 0 0 x\n", ErrorCode::kSyntax},
      {"v 0 0 nan\n", ErrorCode::kNonFinite},
      {"v 0 0 -1e999\n", ErrorCode::kNonFinite},
      {std::string(kVertices) + "f 1 2 5\n", ErrorCode::kIndexOutOfRange},
      {std::string(kVertices) + "f 0 1 2\n", ErrorCode::kIndexOutOfRange},
      {std::string(kVertices) + "f -5 1 2\n", ErrorCode::kIndexOutOfRange},
      {std::string(kVertices) + "f 1 2 99999999999999999999\n", ErrorCode::kSyntax},
      {std::string(kVertices) + "f 1 2 a\n", ErrorCode::kSyntax},
      {std::string(kVertices) + "f 1 2\n", ErrorCode::kDegenerateFacet},
      {std::string(kVertices) + "f\n", ErrorCode::kDegenerateFacet},
      {std::string(kVertices) + "f 1 2 3 1\n", ErrorCode::kDegenerateFacet},
      {kVertices, ErrorCode::kDegenerateGeometry},
      {"", ErrorCode::kDegenerateGeometry}};
  for (const auto& [text, code] : cases) {
    const Error error = error_of(text);
    EXPECT_EQ(error.code, code) << text << ": " << error.message;
  }
  EXPECT_NE(error_of(std::string(kVertices) + "\n\nf 1 2 5\n").message.find("line 7"),
            std::string::npos);
}

}  // namespace
}  // namespace symcell
