// Groups of faces from files to outputs: names that files give, and a flange as CAD has it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "api/formats/model_reader.hpp"
#include "api/schema/statistics_json.hpp"
#include "core/mesh_model.hpp"
#include "tests/support/test_files.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

using Json = nlohmann::ordered_json;

TriangleSurface surface_of(const std::string& text, ModelFormat format) {
  auto model = read_model(text, format);
  EXPECT_TRUE(model) << (model ? "" : model.error().message);
  return model ? std::get<TriangleSurface>(*model) : TriangleSurface{};
}

TEST(PartNames, OfSolidsInStl) {
  const std::string facet =
      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  const auto two = surface_of("solid  in let \r\n" + facet + "endsolid in let\nsolid wall\n" +
                                  facet + facet + "endsolid\nsolid in let\n" + facet + "endsolid\n",
                              ModelFormat::kStl);
  EXPECT_EQ(two.group_names, (std::vector<std::string>{"in let", "wall"}));
  EXPECT_EQ(two.groups, (std::vector<std::int32_t>{0, 1, 1, 0}));
  // One name for all names nothing.
  const auto one = surface_of("solid part\n" + facet + "endsolid\n", ModelFormat::kStl);
  EXPECT_TRUE(one.group_names.empty());
  const auto same = surface_of("solid a\n" + facet + "endsolid\nsolid a\n" + facet + "endsolid\n",
                               ModelFormat::kStl);
  EXPECT_TRUE(same.group_names.empty());
}

TEST(PartNames, OfGroupsMaterialsAndObjectsInObj) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const auto groups = surface_of(
      points + "f 1 2 3\ng lid left\nf 1 2 4\nf 1 2 3 4\nusemtl red\nf 2 3 4\n", ModelFormat::kObj);
  EXPECT_EQ(groups.group_names, (std::vector<std::string>{"unnamed", "lid left"}));
  EXPECT_EQ(groups.groups, (std::vector<std::int32_t>{0, 1, 1, 1, 1}));
  const auto materials =
      surface_of(points + "o all\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 2 4\n", ModelFormat::kObj);
  EXPECT_EQ(materials.group_names, (std::vector<std::string>{"red", "blue"}));
  const auto objects = surface_of(points + "o a\nf 1 2 3\no b\nf 1 2 4\n", ModelFormat::kObj);
  EXPECT_EQ(objects.group_names, (std::vector<std::string>{"a", "b"}));
}

constexpr double kPi = std::numbers::pi;

// A hub of 50 mm on a plate of 100 mm, bored, with eight holes: areas of the CAD model.
const std::map<std::string, double> kFlange = {{"bore", 2 * kPi * 15 * 28},
                                               {"rim", 2 * kPi * 50 * 8},
                                               {"cylinder_r25_1", 2 * kPi * 25 * 20},
                                               {"hole_r5_1", 8 * 2 * kPi * 5 * 8},
                                               {"plane_1", kPi*(50.0 * 50 - 15 * 15 - 8 * 25)},
                                               {"plane_2", kPi*(50.0 * 50 - 25 * 25 - 8 * 25)},
                                               {"plane_3", kPi*(25.0 * 25 - 15 * 15)}};

Model flange() {
  auto model = read_model(test::read_file(test::data_file("models/s3_01_flange_n8_coarse.stl.gz")),
                          ModelFormat::kStl);
  EXPECT_TRUE(model);
  return std::move(*model);
}

TEST(FaceGroupsOfFiles, OfAFlangeAreAsInCad) {
  ExecutionContext context;
  const auto found = inspect_model(flange(), {}, context);
  ASSERT_TRUE(found) << found.error().message;
  const Json document = inspection_to_json(*found);
  EXPECT_EQ(document["fold"], 8);
  std::map<std::string, double> areas;
  for (const Json& g : document["groups"]) areas[g["name"]] = g["area"];
  ASSERT_EQ(areas.size(), kFlange.size());
  for (const auto& [name, area] : kFlange) EXPECT_NEAR(areas[name], area, 0.01 * area) << name;
  for (const Json& g : document["groups"]) {
    if (g["name"] != "hole_r5_1") continue;
    EXPECT_EQ(g["faces"], 8);
    EXPECT_EQ(g["concave"], true);
    EXPECT_NEAR(g["radius"].get<double>(), 5, 0.01);
    const Json& o = g["axis"]["origin"];
    EXPECT_NEAR(std::hypot(o[0].get<double>(), o[1].get<double>()), 38, 0.01);
  }
}

double area_of(const Json& nodes, const Json& facet) {
  const auto at = [&](std::size_t i) {
    const Json& p = nodes[facet["nodes"][i].get<std::size_t>()];
    return Point3{p[0], p[1], p[2]};
  };
  return length(cross(at(1) - at(0), at(2) - at(0))) / 2;
}

TEST(FaceGroupsOfFiles, AreMarkersOfOutputs) {
  ExecutionContext context;
  MeshOptions options;
  options.sizes = {{SizeRequest::Kind::kGroup, 0, 2.0, "bore"}};
  const auto outcome = mesh_model(flange(), options, context);
  ASSERT_TRUE(outcome) << outcome.error().message;
  for (const MeshPart part : {MeshPart::kCell, MeshPart::kFull}) {
    const Json mesh = Json::parse(test::written(outcome->mesh, part, MeshFormat::kJson));
    std::map<std::string, double> areas;
    for (const Json& facet : mesh["boundary"]) {
      areas[mesh["marker_names"][std::to_string(facet["marker"].get<int>())]] +=
          area_of(mesh["nodes"], facet);
    }
    ASSERT_EQ(areas.size(), kFlange.size());
    for (const auto& [name, area] : kFlange) {
      const double share = part == MeshPart::kCell ? 8 : 1;
      EXPECT_NEAR(share * areas[name], area, 0.01 * area) << name;
    }
  }
  const std::string msh = test::written(outcome->mesh, MeshPart::kCell, MeshFormat::kMsh);
  EXPECT_NE(msh.find("\"hole_r5_1\""), std::string::npos);
  const std::string inp = test::written(outcome->mesh, MeshPart::kCell, MeshFormat::kInp);
  EXPECT_NE(inp.find("*NSET, NSET=bore"), std::string::npos);
  EXPECT_NE(inp.find("*SURFACE, NAME=hole_r5_1"), std::string::npos);
}

}  // namespace
}  // namespace symcell
