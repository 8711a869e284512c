#include <gtest/gtest.h>

#include "api/formats/mesh_writer.hpp"

namespace symcell {
namespace {

TEST(MeshFormatNames, NamesAndEndings) {
  EXPECT_EQ(mesh_format_from_name("vtu"), MeshFormat::kVtu);
  EXPECT_EQ(mesh_format_from_name(".MSH"), MeshFormat::kMsh);
  EXPECT_EQ(mesh_format_from_name(".STL"), MeshFormat::kStl);
  EXPECT_EQ(mesh_format_from_name("INP"), MeshFormat::kInp);
  EXPECT_FALSE(mesh_format_from_name("dxf"));
  EXPECT_FALSE(mesh_format_from_name(""));
  for (const MeshFormat format :
       {MeshFormat::kJson, MeshFormat::kVtu, MeshFormat::kMsh, MeshFormat::kInp, MeshFormat::kBdf,
        MeshFormat::kCdb, MeshFormat::kVtp, MeshFormat::kGlb, MeshFormat::kSvg, MeshFormat::kStl}) {
    EXPECT_EQ(mesh_format_from_name(mesh_format_name(format)), format);
    const std::int32_t dimension = format == MeshFormat::kStl ? 3 : 2;
    EXPECT_EQ(mesh_format_from_accept(mesh_format_media_type(format), dimension), format);
  }
}

TEST(MeshFormatNames, AcceptHeaders) {
  EXPECT_EQ(mesh_format_from_accept("", 2), MeshFormat::kVtu);
  EXPECT_EQ(mesh_format_from_accept("*/*", 2), MeshFormat::kVtu);
  EXPECT_EQ(mesh_format_from_accept("image/*", 2), MeshFormat::kSvg);
  EXPECT_EQ(mesh_format_from_accept("text/html, application/json;q=0.9, */*;q=0.1", 2),
            MeshFormat::kJson);
  EXPECT_EQ(mesh_format_from_accept("application/json;q=0.2, model/x-gmsh;q=0.8", 2),
            MeshFormat::kMsh);
  EXPECT_EQ(mesh_format_from_accept("application/vnd.vtk.vtu+xml;q=0, */*;q=0.5", 2),
            MeshFormat::kJson);
  EXPECT_FALSE(mesh_format_from_accept("text/html", 2));
  EXPECT_FALSE(mesh_format_from_accept("application/json;q=0", 2));
  EXPECT_EQ(mesh_format_from_accept("Application/JSON ; Q=1.0", 2), MeshFormat::kJson);
}

TEST(MeshFormatNames, PicturesArePlanarAndStlSolid) {
  EXPECT_TRUE(check_mesh_format(MeshFormat::kVtu, 3));
  EXPECT_TRUE(check_mesh_format(MeshFormat::kSvg, 2));
  EXPECT_TRUE(check_mesh_format(MeshFormat::kStl, 3));
  EXPECT_EQ(check_mesh_format(MeshFormat::kSvg, 3).error().code, ErrorCode::kUnsupportedModel);
  EXPECT_EQ(check_mesh_format(MeshFormat::kStl, 2).error().code, ErrorCode::kUnsupportedModel);
  EXPECT_EQ(mesh_format_from_accept("model/stl, */*;q=0.1", 3), MeshFormat::kStl);
  EXPECT_EQ(mesh_format_from_accept("model/stl, */*;q=0.1", 2), MeshFormat::kVtu);
  EXPECT_FALSE(mesh_format_from_accept("image/svg+xml", 3));
}

}  // namespace
}  // namespace symcell
