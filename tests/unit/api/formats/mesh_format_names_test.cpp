#include <gtest/gtest.h>

#include "api/formats/mesh_writer.hpp"

namespace symcell {
namespace {

TEST(MeshFormatNames, NamesAndEndings) {
  EXPECT_EQ(mesh_format_from_name("vtu"), MeshFormat::kVtu);
  EXPECT_EQ(mesh_format_from_name(".MSH"), MeshFormat::kMsh);
  EXPECT_FALSE(mesh_format_from_name("stl"));
  EXPECT_FALSE(mesh_format_from_name(""));
  for (const MeshFormat format :
       {MeshFormat::kJson, MeshFormat::kVtu, MeshFormat::kMsh, MeshFormat::kSvg}) {
    EXPECT_EQ(mesh_format_from_name(mesh_format_name(format)), format);
    EXPECT_EQ(mesh_format_from_accept(mesh_format_media_type(format)), format);
  }
}

TEST(MeshFormatNames, AcceptHeaders) {
  EXPECT_EQ(mesh_format_from_accept(""), MeshFormat::kVtu);
  EXPECT_EQ(mesh_format_from_accept("*/*"), MeshFormat::kVtu);
  EXPECT_EQ(mesh_format_from_accept("image/*"), MeshFormat::kSvg);
  EXPECT_EQ(mesh_format_from_accept("text/html, application/json;q=0.9, */*;q=0.1"),
            MeshFormat::kJson);
  EXPECT_EQ(mesh_format_from_accept("application/json;q=0.2, model/x-gmsh;q=0.8"),
            MeshFormat::kMsh);
  EXPECT_EQ(mesh_format_from_accept("application/vnd.vtk.vtu+xml;q=0, */*;q=0.5"),
            MeshFormat::kJson);
  EXPECT_FALSE(mesh_format_from_accept("text/html"));
  EXPECT_FALSE(mesh_format_from_accept("application/json;q=0"));
  EXPECT_EQ(mesh_format_from_accept("Application/JSON ; Q=1.0"), MeshFormat::kJson);
}

}  // namespace
}  // namespace symcell
