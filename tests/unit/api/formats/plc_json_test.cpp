#include "api/formats/plc_json.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_files.hpp"

namespace symcell {
namespace {

Error error_of(std::string_view text) {
  const auto model = read_plc_json(text);
  EXPECT_FALSE(model.has_value()) << text.substr(0, 200);
  return model ? Error{} : model.error();
}

ErrorCode code_of(std::string_view text) {
  return error_of(text).code;
}

// A model with `text` in the place of `field`'s value; the rest is empty lists.
std::string with(const std::string& field, const std::string& text) {
  std::string model = R"({"type":"plc")";
  for (const char* name : {"vertices", "facets"}) {
    if (field != name) model += std::string(",\"") + name + "\":[]";
  }
  return model + ",\"" + field + "\":" + text + "}";
}

TEST(PlcJson, ReadsEveryField) {
  const auto model = read_plc_json(R"({"units": "mm", "name": [{"x": [[]]}],
    "vertices": [[0, 0, 0], [1.5, 0, 1e0], [0, 1, -2]],
    "facets": [{"polygons": [[0, 1, 2], [2, 0]], "marker": 7, "holes": [[0.1, 0.2, 0.3]]},
               {"polygons": []}, {"marker": null, "polygons": [[0, 1, 2, 0]]}],
    "segments": [[0, 1], [1, 2, -4]], "holes": [[1, 2, 3]],
    "regions": [{"point": [0.1, 0.2, 0.3], "attribute": 3, "max_volume": 0.5},
                {"max_volume": null, "point": [9, 9, 9]}], "type": "plc"})");
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->vertices[1], (Point3{1.5, 0, 1}));
  ASSERT_EQ(model->facets.size(), 3U);
  EXPECT_EQ(model->facets[0], (PlcFacet{{{0, 1, 2}, {2, 0}}, {{0.1, 0.2, 0.3}}, 7}));
  EXPECT_TRUE(model->facets[1].polygons.empty());
  EXPECT_EQ(model->facets[2], (PlcFacet{{{0, 1, 2, 0}}, {}, 0}));
  EXPECT_EQ(model->segments, (std::vector<PlcSegment>{{0, 1, 0}, {1, 2, -4}}));
  EXPECT_EQ(model->holes, std::vector<Point3>({{1, 2, 3}}));
  ASSERT_EQ(model->regions.size(), 2U);
  EXPECT_EQ(model->regions[0], (PlcRegion{{0.1, 0.2, 0.3}, 3, 0.5}));
  EXPECT_TRUE(std::isinf(model->regions[1].max_volume));
}

TEST(PlcJson, WritesWhatItReads) {
  Plc plc;
  plc.vertices = {{0, 1.0 / 3, 1e-300}, {-1, 2, 3}, {4, 5, 6}};
  plc.facets = {{{{0, 1, 2}, {0, 1}}, {{1, 2, 3}, {4, 5, 6}}, -3}, {{{2, 1, 0}}, {}, 0}};
  plc.segments = {{0, 1, 0}, {1, 2, 5}};
  plc.holes = {{7, 8, 9}};
  plc.regions = {{{1, 1, 1}, 2, 0.125}, {{2, 2, 2}, 0, std::numeric_limits<double>::infinity()}};
  const auto back = read_plc_json(write_plc_json(plc));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->vertices, plc.vertices);
  EXPECT_EQ(back->facets, plc.facets);
  EXPECT_EQ(back->segments, plc.segments);
  EXPECT_EQ(back->holes, plc.holes);
  EXPECT_EQ(back->regions, plc.regions);
}

TEST(PlcJson, ErrorsHaveAPointer) {
  struct Case {
    std::string text;
    ErrorCode code;
    const char* pointer;
  };
  const Case cases[] = {
      {with("vertices", "[[0,0,0],[1,2]]"), ErrorCode::kWrongType, "/vertices/1"},
      {with("vertices", "[[0,0,\"x\"]]"), ErrorCode::kWrongType, "/vertices/0/2"},
      {with("vertices", "[[0,0,1e999]]"), ErrorCode::kNonFinite, "/vertices/0/2"},
      {with("vertices", "[[0,NaN,0]]"), ErrorCode::kNonFinite, "/vertices/0/1"},
      {with("facets", "[[0,1,2]]"), ErrorCode::kWrongType, "/facets/0"},
      {with("facets", "[{\"polygons\":[[0,1,2]]},{}]"), ErrorCode::kMissingField, "/facets/1"},
      {with("facets", "[{\"polygons\":[0,1,2]}]"), ErrorCode::kWrongType, "/facets/0/polygons/0"},
      {with("facets", "[{\"polygons\":[[0,1.5,2]]}]"), ErrorCode::kWrongType,
       "/facets/0/polygons/0/1"},
      {with("facets", "[{\"polygons\":[[0,1,5000000000]]}]"), ErrorCode::kIndexOutOfRange,
       "/facets/0/polygons/0/2"},
      {with("facets", "[{\"polygons\":[],\"marker\":1.5}]"), ErrorCode::kWrongType,
       "/facets/0/marker"},
      {with("facets", "[{\"polygons\":[],\"holes\":[[1,2]]}]"), ErrorCode::kWrongType,
       "/facets/0/holes/0"},
      {with("facets", "[{\"polygons\":[],\"polygons\":[]}]"), ErrorCode::kWrongType,
       "/facets/0/polygons"},
      {with("facets", "[{\"polygon\":[]}]"), ErrorCode::kWrongType, "/facets/0"},
      {with("segments", "[[0]]"), ErrorCode::kWrongType, "/segments/0"},
      {with("segments", "[[0,1.5]]"), ErrorCode::kWrongType, "/segments/0/1"},
      {with("regions", "[{\"point\":[1,2]}]"), ErrorCode::kWrongType, "/regions/0/point"},
      {with("regions", "[{\"attribute\":1}]"), ErrorCode::kMissingField, "/regions/0"},
      {with("regions", "[{\"point\":[1,2,3],\"max_volume\":0}]"), ErrorCode::kWrongType,
       "/regions/0/max_volume"},
      {with("regions", "[{\"point\":[1,2,3],\"max_area\":1}]"), ErrorCode::kWrongType,
       "/regions/0"},
      {with("regions", "{}"), ErrorCode::kWrongType, "/regions"},
      {R"({"type":"pslg","vertices":[],"facets":[]})", ErrorCode::kWrongType, "/type"},
      {R"({"type":"plc","facets":[]})", ErrorCode::kMissingField, "/vertices"},
      {R"({"type":"plc","vertices":[]})", ErrorCode::kMissingField, "/facets"},
      {R"({"vertices":[],"facets":[]})", ErrorCode::kMissingField, "/type"}};
  for (const Case& c : cases) {
    const Error error = error_of(c.text);
    EXPECT_EQ(error.code, c.code) << c.text << ": " << error.message;
    EXPECT_EQ(error.pointer, c.pointer) << c.text << ": " << error.message;
    EXPECT_NE(error.message.find("byte"), std::string::npos) << error.message;
  }
}

TEST(PlcJson, EachPlaceRefusesEveryOtherType) {
  const char* values[] = {"null", "true", "\"a\"", "3", "{}", "[[[]]]", "{\"point\":5}"};
  const std::pair<std::string, std::string> frames[] = {
      {"", ""},
      {R"({"type":"plc","facets":[],"vertices":)", "}"},
      {R"({"type":"plc","facets":[],"vertices":[)", "]}"},
      {R"({"type":"plc","facets":[],"vertices":[[1,1,)", "]]}"},
      {R"({"type":"plc","vertices":[],"facets":[)", "]}"},
      {R"({"type":"plc","vertices":[],"facets":[{"polygons":)", "}]}"},
      {R"({"type":"plc","vertices":[],"facets":[{"polygons":[)", "]}]}"},
      {R"({"type":"plc","vertices":[],"facets":[{"polygons":[[)", "]]}]}"},
      {R"({"type":"plc","vertices":[],"facets":[],"regions":[{"point":)", "}]}"},
      {R"({"facets":[],"vertices":[],"type":)", "}"}};
  for (const auto& [before, after] : frames) {
    for (const char* value : values) {
      const std::string text = before + value + after;
      if (text.find("1,1,3") != std::string::npos) continue;  // a vertex
      if (text.find("\"polygons\":[[3]]") != std::string::npos) continue;
      const ErrorCode code = code_of(text);
      EXPECT_TRUE(code == ErrorCode::kWrongType || code == ErrorCode::kMissingField) << text;
    }
  }
}

TEST(PlcJson, DepthIsBounded) {
  EXPECT_EQ(code_of(R"({"type":"plc","facets":)" + std::string(200000, '[')),
            ErrorCode::kJsonTooDeep);
}

TEST(PlcJson, KindsAreToldEarly) {
  EXPECT_EQ(json_model_kind(R"({"type":"plc")"), ModelKind::kPlc);
  EXPECT_EQ(json_model_kind(R"({"name":{"type":"plc"},"type":"pslg","facets":[]})"),
            ModelKind::kPslg);
  EXPECT_EQ(json_model_kind(R"({"vertices":[[0,0,0]],"facets":[)"), ModelKind::kPlc);
  EXPECT_EQ(json_model_kind(R"({"comment":"type","vertices":[],"type":"plc"})"), ModelKind::kPlc);
  for (const char* text : {"", "{", "[]", "5", "{\"type\":5}", "nonsense"}) {
    EXPECT_EQ(json_model_kind(text), ModelKind::kPslg) << text;
  }
  EXPECT_EQ(json_model_kind(std::string(200000, '[')), ModelKind::kPslg);
}

}  // namespace
}  // namespace symcell
