#include "api/formats/pslg_json.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sample_cells.hpp"

namespace symcell {
namespace {

Error error_of(std::string_view text) {
  const auto model = read_pslg_json(text);
  EXPECT_FALSE(model.has_value()) << text.substr(0, 200);
  return model ? Error{} : model.error();
}

ErrorCode code_of(std::string_view text) {
  return error_of(text).code;
}

TEST(PslgJson, ReadsEveryField) {
  const auto model = read_pslg_json(R"({"name": {"deep": [1, {"x": []}]}, "units": "mm",
    "type": "pslg", "vertices": [[0, 0], [1.5, 0], [0, 1e0]], "comment": null,
    "segments": [[0, 1], [1, 2, 7], [2, 0, -1]], "holes": [[0.25, 0.25]],
    "regions": [{"point": [0.1, 0.2], "attribute": 3, "max_area": 0.5}, {"point": [0, 0]},
                {"max_area": null, "point": [9, 9]}]})");
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->vertices[1], (Point2{1.5, 0}));
  EXPECT_EQ(model->segments[1], (PslgSegment{1, 2, 7}));
  EXPECT_EQ(model->segments[0].marker, 0);
  EXPECT_EQ(model->holes.size(), 1U);
  ASSERT_EQ(model->regions.size(), 3U);
  EXPECT_EQ(model->regions[0], (PslgRegion{{0.1, 0.2}, 3, 0.5}));
  EXPECT_TRUE(std::isinf(model->regions[1].max_area));
  EXPECT_TRUE(std::isinf(model->regions[2].max_area));
}

TEST(PslgJson, WritesWhatItReads) {
  for (const test::Sample& sample : test::all_samples()) {
    Pslg model = sample.model;
    model.regions.push_back({{0.1, 1.0 / 3}, -4, 1e-7});
    const auto back = read_pslg_json(write_pslg_json(model));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->vertices, model.vertices);
    EXPECT_EQ(back->segments, model.segments);
    EXPECT_EQ(back->holes, model.holes);
    EXPECT_EQ(back->regions, model.regions);
  }
}

TEST(PslgJson, WrongTypesHaveAPointerAndAByte) {
  const Error error = error_of(R"({"type":"pslg","vertices":[[0,0],[1,"x"]],"segments":[]})");
  EXPECT_EQ(error.code, ErrorCode::kWrongType);
  EXPECT_EQ(error.pointer, "/vertices/1/1");
  EXPECT_NE(error.message.find("near byte 3"), std::string::npos) << error.message;

  EXPECT_EQ(error_of(R"({"type":"pslg","vertices":[[0,0],{"x":1}],"segments":[]})").pointer,
            "/vertices/1");
  EXPECT_EQ(error_of(R"({"type":"pslg","vertices":[[0,0,0]],"segments":[]})").pointer,
            "/vertices/0");
  EXPECT_EQ(error_of(R"({"type":"pslg","vertices":[],"segments":[[0,1,2,3]]})").pointer,
            "/segments/0");
  EXPECT_EQ(error_of(R"({"type":"pslg","vertices":[],"segments":[[0,1.5]]})").pointer,
            "/segments/0/1");
  EXPECT_EQ(
      error_of(R"({"type":"pslg","vertices":[],"segments":[],"regions":[{"point":[1]}]})").pointer,
      "/regions/0/point");
  EXPECT_EQ(
      error_of(
          R"({"type":"pslg","vertices":[],"segments":[],"regions":[{"point":[1,2],"attribute":[]}]})")
          .pointer,
      "/regions/0/attribute");
}

TEST(PslgJson, EachPlaceRefusesEveryOtherType) {
  const char* values[] = {"null", "true", "\"a\"", "3", "{}", "[[[]]]", "{\"point\":5}"};
  const std::pair<std::string, std::string> frames[] = {
      {"", ""},
      {R"({"type":"pslg","segments":[],"vertices":)", "}"},
      {R"({"type":"pslg","segments":[],"vertices":[)", "]}"},
      {R"({"type":"pslg","segments":[],"vertices":[[1,)", "]]}"},
      {R"({"type":"pslg","vertices":[],"segments":[)", "]}"},
      {R"({"type":"pslg","vertices":[],"segments":[],"regions":)", "}"},
      {R"({"type":"pslg","vertices":[],"segments":[],"regions":[)", "]}"},
      {R"({"type":"pslg","vertices":[],"segments":[],"regions":[{"point":)", "}]}"},
      {R"({"segments":[],"vertices":[],"type":)", "}"}};
  for (const auto& [before, after] : frames) {
    for (const char* value : values) {
      const std::string text = before + value + after;
      if (text.find("[[1,3]]") != std::string::npos) continue;  // a vertex
      const ErrorCode code = code_of(text);
      EXPECT_TRUE(code == ErrorCode::kWrongType || code == ErrorCode::kMissingField) << text;
    }
  }
}

TEST(PslgJson, SpellingAndMissingFields) {
  EXPECT_EQ(code_of(R"({"type":"pslg","vertexes":[],"segments":[]})"), ErrorCode::kWrongType);
  EXPECT_EQ(code_of(R"({"type":"pslg","segments":[]})"), ErrorCode::kMissingField);
  EXPECT_EQ(code_of(R"({"type":"pslg","vertices":[]})"), ErrorCode::kMissingField);
  EXPECT_EQ(code_of(R"({"vertices":[],"segments":[]})"), ErrorCode::kMissingField);
  EXPECT_EQ(code_of("{}"), ErrorCode::kMissingField);
  EXPECT_EQ(code_of(R"({"type":"mesh","vertices":[],"segments":[]})"), ErrorCode::kWrongType);
  EXPECT_EQ(code_of(R"({"type":"pslg","vertices":[],"vertices":[],"segments":[]})"),
            ErrorCode::kWrongType);
  EXPECT_EQ(code_of(R"({"type":"pslg","vertices":[],"segments":[],"regions":[{"attribute":1}]})"),
            ErrorCode::kMissingField);
  EXPECT_EQ(code_of(R"({"type":"pslg","vertices":[],"segments":[],"regions":[
                       {"point":[0,0],"max_area":-1}]})"),
            ErrorCode::kWrongType);
}

TEST(PslgJson, SolidsAreToldAsSuch) {
  for (const char* text : {R"({"type":"plc","vertices":[],"facets":[]})",
                           R"({"vertices":[],"facets":[{"polygons":[[0,1,2]]}],"type":"plc"})",
                           R"({"vertices":[],"facets":[]})"}) {
    const Error error = error_of(text);
    EXPECT_EQ(error.code, ErrorCode::kWrongType);
    EXPECT_NE(error.message.find("solid"), std::string::npos);
  }
}

TEST(PslgJson, DepthIsBoundedAnywhere) {
  const std::string open(200000, '[');
  EXPECT_EQ(code_of(R"({"type":"pslg","vertices":)" + open), ErrorCode::kJsonTooDeep);
  EXPECT_EQ(code_of(R"({"comment":)" + open), ErrorCode::kJsonTooDeep);
  EXPECT_EQ(code_of(open), ErrorCode::kJsonTooDeep);
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"name\":";
  EXPECT_EQ(code_of(objects), ErrorCode::kJsonTooDeep);
}

TEST(PslgJson, NumbersThatAreNotFinite) {
  for (const char* number : {"1e999", "-1e999", "NaN", "Infinity", "-Infinity", "nan", "inf"}) {
    const std::string text =
        R"({"type":"pslg","vertices":[[0,0],[1,)" + std::string(number) + R"(]],"segments":[]})";
    const Error error = error_of(text);
    EXPECT_EQ(error.code, ErrorCode::kNonFinite) << number << error.message;
    EXPECT_EQ(error.pointer, "/vertices/1/1");
  }
  const std::string digits(1000000, '9');
  EXPECT_EQ(code_of(R"({"type":"pslg","vertices":[[0,)" + digits + "]]}"), ErrorCode::kNonFinite);
}

TEST(PslgJson, TextThatIsNoJson) {
  for (const char* text : {"", "{", "{\"type\"", "{\"type\":\"pslg\",}", "nonsense", "{} x",
                           "{\"type\":\"ps\xff\"}", "{'type':1}"}) {
    EXPECT_EQ(code_of(text), ErrorCode::kJsonSyntax) << text;
  }
}

TEST(PslgJson, IndicesBeyond32Bits) {
  EXPECT_EQ(code_of(R"({"type":"pslg","vertices":[],"segments":[[0,5000000000]]})"),
            ErrorCode::kIndexOutOfRange);
  // Others are validate_pslg's to refuse.
  EXPECT_TRUE(read_pslg_json(R"({"type":"pslg","vertices":[],"segments":[[0,-1]]})"));
}

TEST(PslgJson, SegmentsMayBeArcs) {
  const auto model = read_pslg_json(R"({"type": "pslg", "segments": [[0, 1],
    {"vertices": [1, 0], "marker": 4, "bulge": 1}, {"vertices": [0, 1], "center": [0, 1]},
    {"vertices": [2, 2], "marker": 5, "center": [0, 0]}],
    "vertices": [[-1, 0], [1, 0], [3, 0]]})");
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_EQ(model->segments.size(), 5U);
  EXPECT_EQ(model->segments[1], (PslgSegment{1, 0, 4}));
  EXPECT_EQ(model->bulge(0), 0);
  EXPECT_EQ(model->bulge(1), 1);
  // A quarter below the centre, counter-clockwise.
  EXPECT_NEAR(model->bulge(2), std::tan(std::acos(-1) / 8), 1e-15);
  EXPECT_EQ(model->vertices[3], (Point2{-3, 0}));
  EXPECT_EQ(model->segments[3], (PslgSegment{2, 3, 5}));
  EXPECT_EQ(model->segments[4], (PslgSegment{3, 2, 5}));
  EXPECT_EQ(model->bulge(4), 1);
  const auto back = read_pslg_json(write_pslg_json(*model));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->segments, model->segments);
  EXPECT_EQ(back->bulges, model->bulges);
}

TEST(PslgJson, ArcsThatAreNone) {
  const auto refused = [](const std::string& segment) {
    const auto model = read_pslg_json(
        "{\"type\": \"pslg\", \"vertices\": [[0, 0], [1, 0], [0, 1]], "
        "\"segments\": [[0, 1], " +
        segment + "]}");
    EXPECT_FALSE(model) << segment;
    return model ? Error{} : model.error();
  };
  EXPECT_EQ(refused(R"({"vertices": [1, 2], "center": [1, 2]})").pointer, "/segments/1/center");
  EXPECT_EQ(refused(R"({"bulge": 1})").code, ErrorCode::kMissingField);
  EXPECT_EQ(refused(R"({"vertices": [0], "bulge": 1})").code, ErrorCode::kWrongType);
  EXPECT_EQ(refused(R"({"vertices": [1, 2], "bulge": 1, "center": [0, 0]})").code,
            ErrorCode::kWrongType);
  EXPECT_EQ(refused(R"({"vertices": [1, 2], "bulge": NaN})").code, ErrorCode::kNonFinite);
  EXPECT_EQ(refused(R"({"vertices": [1, 2], "radius": 1})").code, ErrorCode::kWrongType);
}

}  // namespace
}  // namespace symcell
