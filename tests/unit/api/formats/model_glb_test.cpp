// Pictures of models, sound or not: what is drawn, under which names.
#include "api/formats/model_glb.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

namespace symcell {
namespace {

using Json = nlohmann::ordered_json;

struct Picture {
  Json json;
  [[nodiscard]] Json::const_reference material(const Json& primitive) const {
    return json["materials"][primitive["material"].get<std::size_t>()];
  }
  // Indices of the primitives with a material of that name.
  [[nodiscard]] std::size_t indices(const std::string& name) const {
    std::size_t count = 0;
    for (const Json& primitive : json["meshes"][0]["primitives"]) {
      if (material(primitive)["name"] != name) continue;
      count +=
          json["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::size_t>();
    }
    return count;
  }
};

Picture drawn(const Model& model, std::vector<std::int64_t> at_fault = {}) {
  std::string bytes;
  const auto done = write_model_glb(model, at_fault, {{"said", 1}}, [&](std::string_view piece) {
    bytes += piece;
    return true;
  });
  EXPECT_TRUE(done);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof length);
  Picture picture{Json::parse(bytes.substr(20, length))};
  EXPECT_EQ(picture.json["scenes"][0]["extras"]["said"], 1);
  return picture;
}

Plc box_with_a_window() {
  Plc plc;
  for (const double z : {0.0, 1.0}) {
    for (const Point2 p : {Point2{0, 0}, Point2{4, 0}, Point2{4, 4}, Point2{0, 4}}) {
      plc.vertices.push_back({p.x, p.y, z});
    }
  }
  for (const Point2 p : {Point2{1, 1}, Point2{3, 1}, Point2{3, 3}, Point2{1, 3}}) {
    plc.vertices.push_back({p.x, p.y, 1});
  }
  plc.facets.push_back({{{0, 1, 2, 3}}, {}, 5});
  plc.facets.push_back({{{4, 5, 6, 7}, {8, 9, 10, 11}}, {{2, 2, 1}}, 6});
  return plc;
}

TEST(ModelGlb, FacetsHaveTheirHolesAndGroups) {
  const Picture picture = drawn(box_with_a_window());
  EXPECT_EQ(picture.indices("boundary_5"), 3U * 2);
  EXPECT_EQ(picture.indices("boundary_6"), 3U * 8);
  EXPECT_EQ(picture.indices("boundary_0"), 2U * 12);  // the facets' edges
}

TEST(ModelGlb, WhatIsAtFaultHasAMaterialOfItsOwn) {
  const Picture picture = drawn(box_with_a_window(), {1, 77});
  EXPECT_EQ(picture.indices("at fault"), 3U * 8);
  EXPECT_EQ(picture.indices("boundary_6"), 0U);
}

TEST(ModelGlb, ArcsAreDrawnInChordsAndNamesKept) {
  Pslg pslg{{{0, 0}, {2, 0}}, {{0, 1, 3}, {1, 0, 4}}, {}, {}, {1.0, 0.0}};
  pslg.marker_names = {{3, "round"}};
  const Picture picture = drawn(pslg);
  EXPECT_GT(picture.indices("round"), 2U * 20);
  EXPECT_EQ(picture.indices("boundary_4"), 2U);
}

TEST(ModelGlb, ModelsNeedNotBeSound) {
  TriangleSurface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  surface.triangles = {{0, 1, 2}, {0, 1, 9}, {-1, 0, 1}};
  EXPECT_EQ(drawn(surface).indices("boundary_0"), 3U);
  // Beyond single precision: at its end.
  const Picture huge = drawn(Pslg{{{1e308, 0}, {-1e308, 1}}, {{0, 1, 0}}, {}, {}});
  EXPECT_TRUE(huge.json["accessors"][0]["min"][0].is_number());
  EXPECT_FALSE(write_model_glb(Pslg{}, {}, {}, [](std::string_view) { return true; }));
}

}  // namespace
}  // namespace symcell
