#include "api/schema/options.hpp"

#include <gtest/gtest.h>

#include "api/schema/gates.hpp"

namespace symcell {
namespace {

using Json = nlohmann::json;
constexpr ModelKind kPlanar = ModelKind::kPslg;

ErrorCode code_of(const Result<MeshOptions>& result) {
  EXPECT_FALSE(result.has_value());
  return result ? ErrorCode::kInternal : result.error().code;
}

Result<MeshOptions> from_text(const std::string& name, const std::string& text) {
  return options_from_texts({{name, text}});
}

TEST(OptionsWords, ATextInThePlaceOfAValueIsShownAsText) {
  const auto options = options_from_json(nlohmann::json{{"plain", "true"}});
  ASSERT_FALSE(options);
  EXPECT_NE(options.error().message.find("got \"true\""), std::string::npos)
      << options.error().message;
}

TEST(Options, DefaultsAreThoseOfTheCore) {
  const auto options = options_from_json(Json::object());
  ASSERT_TRUE(options);
  EXPECT_FALSE(options->fold);
  EXPECT_EQ(options->min_angle_deg, 30);
  EXPECT_EQ(options->order, 1);
  EXPECT_EQ(options->symmetry_tolerance_rel, std::nullopt);
}

TEST(Options, JsonAndTextsSetTheSame) {
  const auto json = options_from_json(Json::parse(R"({"fold": 6, "ignore_markers": true,
      "center": [1, -2.5], "symmetry_tolerance": 1e-4, "min_angle": 33, "max_area": 0.5,
      "max_edge": 2, "order": 2, "max_elements": 1000, "time_limit": 1.5, "seed": 7,
      "min_edge": 0.25, "sizes": "marker:3=0.5, vertex:17=0.75", "keep_boundary": true,
      "gradation": 1.5, "divisions": "marker:3=8, marker:-4=1", "keep_vertices": true,
      "plain": true, "strict": true})"));
  const auto texts = options_from_texts({{"fold", "6"},
                                         {"ignore-markers", ""},
                                         {"center", "1,-2.5"},
                                         {"symmetry-tolerance", "1e-4"},
                                         {"min_angle", "33"},
                                         {"max-area", "0.5"},
                                         {"max_edge", "2"},
                                         {"min-edge", "0.25"},
                                         {"sizes", "marker:3=0.5,vertex 17=0.75"},
                                         {"keep-boundary", ""},
                                         {"keep-vertices", ""},
                                         {"gradation", "1.5"},
                                         {"divisions", "marker 3=8,marker:-4=1"},
                                         {"order", "2"},
                                         {"max_elements", "1000"},
                                         {"time-limit", "1.5"},
                                         {"seed", "7"},
                                         {"plain", "true"},
                                         {"strict", ""}});
  ASSERT_TRUE(json) << json.error().message;
  ASSERT_TRUE(texts) << texts.error().message;
  EXPECT_EQ(options_to_json(*json, kPlanar), options_to_json(*texts, kPlanar));
  EXPECT_EQ(json->fold, 6);
  EXPECT_TRUE(json->ignore_markers);
  EXPECT_EQ(json->center, (Point2{1, -2.5}));
  EXPECT_EQ(json->max_area, 0.5);
  EXPECT_EQ(json->max_elements, 1000U);
  EXPECT_EQ(json->seed, 7U);
  EXPECT_TRUE(json->plain);
  EXPECT_TRUE(json->strict);
  EXPECT_EQ(json->min_edge, 0.25);
  EXPECT_TRUE(json->keep_boundary);
  EXPECT_TRUE(json->keep_vertices);
  EXPECT_EQ(json->gradation, 1.5);
  const std::vector<DivisionRequest> divisions = {{3, 8}, {-4, 1}};
  EXPECT_EQ(json->divisions, divisions);
  EXPECT_EQ(options_to_json(*json, kPlanar)["divisions"], "marker:3=8,marker:-4=1");
  const std::vector<SizeRequest> sizes = {{SizeRequest::Kind::kMarker, 3, 0.5},
                                          {SizeRequest::Kind::kVertex, 17, 0.75}};
  EXPECT_EQ(json->sizes, sizes);
  EXPECT_EQ(options_to_json(*json, kPlanar)["sizes"], "marker:3=0.5,vertex:17=0.75");
}

TEST(Options, SizesThatAreNone) {
  for (const char* sizes : {"", "3=0.5", "marker:3", "marker:3=0", "marker:3=-1", "vertex:a=1",
                            "marker:3=0.5,", "marker:3=0.5 vertex:1=1", "marker:3=inf"}) {
    EXPECT_EQ(code_of(from_text("sizes", sizes)), ErrorCode::kBadOption) << sizes;
  }
  EXPECT_EQ(code_of(options_from_json({{"sizes", 3}})), ErrorCode::kBadOption);
}

TEST(Options, DivisionsAndGradationsThatAreNone) {
  for (const char* divisions : {"", "3=8", "marker:3", "marker:3=0", "marker:3=-1", "marker:3=2.5",
                                "vertex:3=8", "marker:3=8,", "marker:3=1000001"}) {
    EXPECT_EQ(code_of(from_text("divisions", divisions)), ErrorCode::kBadOption) << divisions;
  }
  for (const char* gradation : {"", "1", "0", "-2", "1.04", "nan", "fast"}) {
    EXPECT_EQ(code_of(from_text("gradation", gradation)), ErrorCode::kBadOption) << gradation;
  }
  MeshOptions options;
  options.divisions = {{1, 2}};
  EXPECT_EQ(code_of(options_for(ModelKind::kPlc, options)), ErrorCode::kBadOption);
}

TEST(Options, SizesOfSolids) {
  const auto options = from_text(
      "sizes",
      "bore=0.2,marker:3=0.5,region:2=1,point:0/1.5/-2e1=0.1, group:7=3,a b=c=4,vertex:0=9");
  ASSERT_TRUE(options) << options.error().message;
  using Of = SizeRequest::Kind;
  const std::vector<SizeRequest> wanted = {
      {Of::kGroup, 0, 0.2, "bore"}, {Of::kMarker, 3, 0.5},
      {Of::kRegion, 2, 1},          {Of::kPoint, 0, 0.1, "", {0, 1.5, -20}},
      {Of::kGroup, 0, 3, "7"},      {Of::kGroup, 0, 4, "a b=c"},
      {Of::kVertex, 0, 9}};
  EXPECT_EQ(options->sizes, wanted);
  for (const ModelKind kind : {ModelKind::kPlc, ModelKind::kSurface}) {
    const auto fitting = options_for(kind, *options);
    ASSERT_TRUE(fitting);
    const auto json = options_to_json(*fitting, kind);
    const auto back = options_from_json(Json(json));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->sizes, wanted);
  }
  EXPECT_EQ(code_of(options_for(kPlanar, *options)), ErrorCode::kBadOption);
  EXPECT_TRUE(options_for(kPlanar, *from_text("sizes", "layer 1=0.2,vertex:3=1")));
  // What cannot be named so is told how.
  const auto comma = from_text("sizes", "seat, upper=0.2");
  ASSERT_FALSE(comma);
  EXPECT_NE(comma.error().message.find("marker:N"), std::string::npos) << comma.error().message;
  for (const char* bad : {"point:1/2=3", "point:1/2/3/4=3", "point:a/2/3=3", "region:x=1", "=1",
                          "group:=1", "bore", "bore=0", "bore=-1", "bore=nan"}) {
    EXPECT_EQ(code_of(from_text("sizes", bad)), ErrorCode::kBadOption) << bad;
  }
}

TEST(Options, PresetsAndCounts) {
  EXPECT_EQ(from_text("preset", "fine")->preset, Preset::kFine);
  EXPECT_EQ(options_to_json(*from_text("preset", "fine"), ModelKind::kPlc)["preset"], "fine");
  EXPECT_EQ(code_of(from_text("preset", "finest")), ErrorCode::kBadOption);
  EXPECT_EQ(code_of(options_for(kPlanar, *from_text("preset", "fine"))), ErrorCode::kBadOption);
  EXPECT_EQ(from_text("elements", "2e4")->target_elements, 20000U);
  EXPECT_TRUE(options_for(kPlanar, *from_text("elements", "2e4")));
  for (const char* bad : {"0", "-1", "2.5", "1e9", "many"}) {
    EXPECT_EQ(code_of(from_text("elements", bad)), ErrorCode::kBadOption) << bad;
  }
}

TEST(Options, FeatureAnglesAreForSurfaces) {
  const auto angle = from_text("feature_angle", "45");
  ASSERT_TRUE(angle);
  EXPECT_EQ(angle->feature_angle_deg, 45);
  EXPECT_TRUE(options_for(ModelKind::kSurface, *angle));
  EXPECT_EQ(code_of(options_for(ModelKind::kPlc, *angle)), ErrorCode::kBadOption);
  EXPECT_EQ(code_of(options_for(kPlanar, *angle)), ErrorCode::kBadOption);
  EXPECT_EQ(from_text("feature_angle", "0")->feature_angle_deg, 0);
  for (const char* bad : {"-1", "90", "nan", "sharp"}) {
    EXPECT_EQ(code_of(from_text("feature_angle", bad)), ErrorCode::kBadOption) << bad;
  }
}

TEST(Options, FailOnTakesComparisons) {
  const auto gates = from_text("fail_on", "cell.min_dihedral_deg<20, cell.elements >= 1e6");
  ASSERT_TRUE(gates);
  EXPECT_EQ(gates->fail_on.size(), 2U);
  EXPECT_EQ(options_to_json(*gates, kPlanar)["fail_on"],
            "cell.min_dihedral_deg<20, cell.elements >= 1e6");
  for (const char* bad : {"", "cell.elements", "<3", "cell.elements<", "cell.elements<many",
                          "cell.elements=3", "a<1,", "Cell<3", "a<inf"}) {
    EXPECT_EQ(code_of(from_text("fail_on", bad)), ErrorCode::kBadOption) << bad;
  }
}

TEST(Gates, JudgeFiguresOfTheStatistics) {
  const nlohmann::ordered_json statistics = {
      {"cell", {{"elements", 120}, {"min_dihedral_deg", 17.5}}},
      {"warnings", {1, 2}},
      {"delaunay", false},
      {"exempt", {{{"reason", "x"}, {"elements", 3}}}}};
  const auto failed = [&](const char* gate) { return judge({gate}, statistics).at(0).failed; };
  EXPECT_TRUE(failed("cell.min_dihedral_deg<20"));
  EXPECT_FALSE(failed("cell.min_dihedral_deg<17.5"));
  EXPECT_TRUE(failed("cell.min_dihedral_deg<=17.5"));
  EXPECT_TRUE(failed("warnings>0"));
  EXPECT_FALSE(failed("warnings>2"));
  EXPECT_TRUE(failed("exempt.0.elements>=3"));
  EXPECT_TRUE(failed("delaunay==0"));
  EXPECT_FALSE(failed("cell.elements!=120"));
  // What is not there is no reason to be content.
  EXPECT_TRUE(failed("cell.elments>1e6"));
  EXPECT_TRUE(failed("exempt.1.elements>3"));
  EXPECT_TRUE(failed("exempt.0.reason>3"));
  const auto checked = check_gates(judge({"cell.elements>100", "warnings>5"}, statistics));
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, ErrorCode::kGateFailed);
  EXPECT_NE(checked.error().message.find("cell.elements is 120"), std::string::npos);
  EXPECT_EQ(checked.error().message.find("warnings"), std::string::npos);
}

TEST(Options, EdgesTooLongForTheirHalves) {
  MeshOptions options;
  options.max_edge = 1;
  options.min_edge = 0.5;
  EXPECT_TRUE(options_for(kPlanar, options));
  options.sizes.push_back({SizeRequest::Kind::kMarker, 1, 0.9});
  EXPECT_EQ(code_of(options_for(kPlanar, options)), ErrorCode::kBadOption);
}

TEST(Options, FoldsThatAreNone) {
  for (const char* fold : {"0", "-3", "2.5", "\"four\"", "1000000007", "1e300", "[2]", "true",
                           "\"\"", "30001", "{\"n\":1}", "-1e30"}) {
    const auto options = options_from_json({{"fold", Json::parse(fold)}});
    EXPECT_EQ(code_of(options), ErrorCode::kBadFold) << fold;
    EXPECT_EQ(options.error().pointer, "/options/fold");
  }
  for (const char* fold : {"0", "-3", "2.5", "four", "1000000007", "", "nan", "6x", "inf"}) {
    EXPECT_EQ(code_of(from_text("fold", fold)), ErrorCode::kBadFold) << fold;
  }
  EXPECT_EQ(from_text("fold", "1")->fold, 1);
  EXPECT_FALSE(from_text("fold", "auto")->fold);
  EXPECT_EQ(options_from_json({{"fold", 2.0}})->fold, 2);
  EXPECT_EQ(from_text("fold", std::to_string(kMaxFold))->fold, kMaxFold);
}

TEST(Options, HelpNamesTheLargestFold) {
  EXPECT_NE(mesh_option_table()[0].help.find(std::to_string(kMaxFold)), std::string_view::npos);
}

TEST(Options, NumbersOutOfRange) {
  const std::pair<const char*, const char*> bad[] = {{"min_angle", "42.5"},
                                                     {"min_angle", "-1"},
                                                     {"min_angle", "nan"},
                                                     {"min_angle", "abc"},
                                                     {"max_area", "0"},
                                                     {"max_area", "-2"},
                                                     {"max_area", "inf"},
                                                     {"max_edge", "1e999"},
                                                     {"order", "3"},
                                                     {"order", "1.5"},
                                                     {"max_elements", "0"},
                                                     {"max_elements", "-5"},
                                                     {"time_limit", "0"},
                                                     {"time_limit", "-1"},
                                                     {"seed", "-1"},
                                                     {"seed", "1.5"},
                                                     {"symmetry_tolerance", "0"},
                                                     {"symmetry_tolerance", "2"},
                                                     {"ignore_markers", "maybe"},
                                                     {"plain", "2"},
                                                     {"radius_edge", "0.9"},
                                                     {"radius_edge", "101"},
                                                     {"radius_edge", "nan"},
                                                     {"min_dihedral", "-1"},
                                                     {"min_dihedral", "71"},
                                                     {"max_volume", "0"},
                                                     {"max_volume", "inf"},
                                                     {"delaunay", "perhaps"},
                                                     {"memory_limit", "0"},
                                                     {"memory_limit", "63"},
                                                     {"memory_limit", "1e12"},
                                                     {"memory_limit", "100.5"}};
  for (const auto& [name, text] : bad) {
    const auto options = from_text(name, text);
    EXPECT_EQ(code_of(options), ErrorCode::kBadOption) << name << " " << text;
    EXPECT_EQ(options.error().pointer, std::string("/options/") + name);
    EXPECT_NE(options.error().message.find(name), std::string::npos);
  }
  EXPECT_EQ(from_text("min_angle", "42")->min_angle_deg, 42);
  EXPECT_EQ(from_text("min_angle", "0")->min_angle_deg, 0);
  EXPECT_EQ(from_text("seed", "18446744073709551615")->seed, ~std::uint64_t{0});
}

TEST(Options, CentreAndAxisOfPlanarModels) {
  const auto planar = [](const std::string& name, const std::string& text) {
    return options_for(kPlanar, from_text(name, text).value());
  };
  EXPECT_EQ(planar("axis_origin", "1,2,0")->center, (Point2{1, 2}));
  EXPECT_EQ(planar("axis_origin", "1,2")->center, (Point2{1, 2}));
  EXPECT_EQ(planar("center", " 1 , +2")->center, (Point2{1, 2}));
  EXPECT_TRUE(planar("axis_direction", "0,0,1"));
  EXPECT_TRUE(planar("axis_direction", "0,0,-1"));
  EXPECT_EQ(code_of(planar("axis_direction", "1,0,0")), ErrorCode::kBadAxis);
  EXPECT_EQ(code_of(planar("axis_origin", "1,2,3")), ErrorCode::kBadAxis);
  EXPECT_TRUE(options_from_json({{"axis_direction", nullptr}, {"axis_origin", {3, 4}}}));
  for (const char* center : {"1", "1,2,3", "1,2,0,0", "nan,0", "1,inf", "a,b", "1,", ",1", "1;2"}) {
    EXPECT_EQ(code_of(from_text("center", center)), ErrorCode::kBadAxis) << center;
  }
  EXPECT_EQ(code_of(options_from_json({{"center", {1, 2}}, {"axis_origin", {1, 3}}})),
            ErrorCode::kBadAxis);
  const auto both = options_from_json({{"center", {1, 2}}, {"axis_origin", {1, 3, 0}}});
  EXPECT_EQ(code_of(options_for(kPlanar, both.value())), ErrorCode::kBadAxis);
  EXPECT_EQ(code_of(options_from_json({{"center", {"1", "2"}}})), ErrorCode::kBadAxis);
}

TEST(Options, AxisOfSolids) {
  const auto options = options_from_texts({{"axis-origin", "1,2,3"}, {"axis-direction", "0,3,-4"}});
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->axis_origin, (Point3{1, 2, 3}));
  EXPECT_EQ(options->axis_direction, (Point3{0, 3, -4}));
  for (const ModelKind kind : {ModelKind::kPlc, ModelKind::kSurface}) {
    EXPECT_TRUE(options_for(kind, *options));
  }
  for (const char* axis : {"0,0,0", "-0,0,0", "nan,0,1", "inf,0,1", "0,1", "1e-300,0,0",
                           "1e300,0,0", "1,2,3,4", "z", ""}) {
    const auto bad = from_text("axis_direction", axis);
    EXPECT_EQ(code_of(bad), ErrorCode::kBadAxis) << axis;
    EXPECT_EQ(bad.error().pointer, "/options/axis_direction");
  }
  EXPECT_EQ(code_of(options_from_json({{"axis_direction", {0, 0, 0}}})), ErrorCode::kBadAxis);
  EXPECT_EQ(code_of(options_from_json({{"axis_direction", {0, nullptr, 1}}})), ErrorCode::kBadAxis);
  for (const char* origin : {"1", "nan,0,0", "1,2,inf", "1,2,3,4", "origin"}) {
    EXPECT_EQ(code_of(from_text("axis_origin", origin)), ErrorCode::kBadAxis) << origin;
  }
  // Two coordinates leave open where the axis is.
  EXPECT_EQ(code_of(options_for(ModelKind::kPlc, from_text("axis_origin", "1,2").value())),
            ErrorCode::kBadAxis);
}

TEST(Options, ThoseOfTheOtherKindAreRefused) {
  const std::pair<const char*, const char*> solids[] = {
      {"radius_edge", "2"}, {"max_volume", "1"}, {"min_dihedral", "10"}, {"delaunay", ""}};
  for (const auto& [name, text] : solids) {
    const auto options = from_text(name, text);
    ASSERT_TRUE(options) << name;
    EXPECT_TRUE(options_for(ModelKind::kPlc, *options)) << name;
    const auto planar = options_for(kPlanar, *options);
    EXPECT_EQ(code_of(planar), ErrorCode::kBadOption) << name;
    EXPECT_NE(planar.error().message.find("solid"), std::string::npos);
    EXPECT_EQ(planar.error().pointer, std::string("/options/") + name);
  }
  const std::pair<const char*, const char*> planar[] = {{"min_angle", "20"}, {"max_area", "1"}};
  for (const auto& [name, text] : planar) {
    const auto options = from_text(name, text);
    ASSERT_TRUE(options) << name;
    EXPECT_TRUE(options_for(kPlanar, *options)) << name;
    const auto solid = options_for(ModelKind::kSurface, *options);
    EXPECT_EQ(code_of(solid), ErrorCode::kBadOption) << name;
    EXPECT_EQ(solid.error().pointer, std::string("/options/") + name);
  }
  EXPECT_EQ(code_of(options_for(ModelKind::kSurface, from_text("center", "0,0").value())),
            ErrorCode::kBadAxis);
  // What asks for nothing fits.
  const auto nothing = options_from_json({{"radius_edge", nullptr}, {"delaunay", false}});
  EXPECT_TRUE(options_for(kPlanar, nothing.value()));
}

TEST(Options, UnknownNamesAreRefusedWithASuggestion) {
  const auto options = options_from_json({{"minangle", 30}});
  EXPECT_EQ(code_of(options), ErrorCode::kBadOption);
  EXPECT_EQ(options.error().pointer, "/options/minangle");
  EXPECT_NE(options.error().message.find("\"min_angle\""), std::string::npos);
  EXPECT_EQ(options_from_json({{"a/b~c", 1}}).error().pointer, "/options/a~1b~0c");
  EXPECT_EQ(code_of(options_from_json(Json::array())), ErrorCode::kBadOption);
  EXPECT_EQ(code_of(options_from_texts({{"fold", "2"}, {"fold", "3"}})), ErrorCode::kBadOption);
  // Foreign bytes stay out of messages.
  EXPECT_EQ(options_from_json({{"\xff\x01", 1}}).error().message, "there is no option \"\?\?\"");
}

TEST(Options, SettingsTellEveryNameAndReadBack) {
  MeshOptions options;
  options.fold = 5;
  options.center = Point2{1, 2};
  options.max_area = 3;
  const auto json = options_to_json(options, kPlanar);
  EXPECT_EQ(json.size(), mesh_option_table().size());
  EXPECT_TRUE(json["max_edge"].is_null());
  const auto back = options_from_json(Json(json));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(options_to_json(*back, kPlanar), json);
}

TEST(Options, ArcsArePlanarAndSectorsAnythingButPlcs) {
  const auto sector = from_text("sector", "8");
  ASSERT_TRUE(sector);
  EXPECT_EQ(sector->sector, 8);
  const auto chords = from_text("chord_error", "0.01");
  ASSERT_TRUE(chords);
  EXPECT_EQ(chords->chord_error_rel, 0.01);
  for (const auto& options : {*sector, *chords}) {
    EXPECT_TRUE(options_for(kPlanar, options));
    EXPECT_EQ(code_of(options_for(ModelKind::kPlc, options)), ErrorCode::kBadOption);
  }
  EXPECT_TRUE(options_for(ModelKind::kSurface, *sector));
  EXPECT_TRUE(options_for(ModelKind::kSurface, *chords));
  for (const char* bad : {"1", "0", "2.5", "30001", "x"}) {
    EXPECT_EQ(code_of(from_text("sector", bad)), ErrorCode::kBadFold) << bad;
  }
  for (const char* bad : {"0", "0.2", "-1", "nan"}) {
    EXPECT_EQ(code_of(from_text("chord_error", bad)), ErrorCode::kBadOption) << bad;
  }
}

TEST(Options, RepairIsNotForPlcs) {
  const auto wrap = from_text("repair", "wrap");
  ASSERT_TRUE(wrap);
  EXPECT_EQ(wrap->repair, Repair::kWrap);
  EXPECT_TRUE(options_for(ModelKind::kSurface, *wrap));
  for (const ModelKind kind : {ModelKind::kPlc, kPlanar}) {
    EXPECT_EQ(code_of(options_for(kind, *wrap)), ErrorCode::kBadOption);
  }
  const auto all = from_text("repair", "all");
  ASSERT_TRUE(all);
  EXPECT_TRUE(options_for(kPlanar, *all));
  EXPECT_EQ(code_of(options_for(ModelKind::kPlc, *all)), ErrorCode::kBadOption);
  EXPECT_EQ(code_of(from_text("repair", "some")), ErrorCode::kBadOption);
  EXPECT_EQ(options_to_json(*wrap, ModelKind::kSurface)["repair"], "wrap");
  EXPECT_TRUE(options_to_json({}, ModelKind::kPlc)["repair"].is_null());
}

TEST(Options, SettingsOfSolidsReadBack) {
  const auto options = options_from_json({{"axis_origin", {0, 0, 1}},
                                          {"axis_direction", {0, 0, 2}},
                                          {"radius_edge", 1.6},
                                          {"max_volume", 0.25},
                                          {"min_dihedral", 12},
                                          {"delaunay", true},
                                          {"memory_limit", 512}});
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->memory_limit_bytes, std::uint64_t{512} << 20U);
  const auto json = options_to_json(*options, ModelKind::kSurface);
  EXPECT_EQ(json.size(), mesh_option_table().size());
  EXPECT_TRUE(json["min_angle"].is_null());
  EXPECT_EQ(json["symmetry_tolerance"], kSurfaceSymmetryToleranceRel);
  EXPECT_EQ(json["memory_limit"], 512);
  const auto back = options_from_json(Json(json));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(options_to_json(*back, ModelKind::kSurface), json);
  EXPECT_EQ(options_to_json({}, ModelKind::kPlc)["symmetry_tolerance"], kExactSymmetryToleranceRel);
}

}  // namespace
}  // namespace symcell
