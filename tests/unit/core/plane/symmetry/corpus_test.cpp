// The plane models of the shared corpus: fold, centre and error found with the tolerance a user
// would give. Skipped where the corpus is not beside the source tree.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/plane/input/validate_pslg.hpp"
#include "core/plane/symmetry/symmetrise.hpp"
#include "tests/support/symmetry_checks.hpp"

namespace symcell::plane {
namespace {

using Json = nlohmann::json;

std::filesystem::path corpus() {
  return std::filesystem::path(SYMCELL_SOURCE_DIR) / ".." / "shared" / "corpus";
}

Json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return Json::parse(file);
}

Pslg read_pslg(const Json& json) {
  Pslg pslg;
  const auto point = [](const Json& p) { return Point2{p[0].get<double>(), p[1].get<double>()}; };
  for (const Json& v : json.at("vertices")) pslg.vertices.push_back(point(v));
  for (const Json& s : json.at("segments")) {
    const std::int32_t marker = s.size() > 2 ? s[2].get<std::int32_t>() : 0;
    pslg.segments.push_back({s[0].get<std::int32_t>(), s[1].get<std::int32_t>(), marker});
  }
  for (const Json& h : json.value("holes", Json::array())) pslg.holes.push_back(point(h));
  for (const Json& r : json.value("regions", Json::array())) {
    PslgRegion region{point(r.at("point")), r.value("attribute", 0)};
    if (r.contains("max_area") && r["max_area"].is_number()) region.max_area = r["max_area"];
    pslg.regions.push_back(region);
  }
  return pslg;
}

TEST(SharedData, EveryPlaneModelHasTheFoldOfTheManifest) {
  if (!std::filesystem::exists(corpus() / "manifest.json")) {
    GTEST_SKIP() << "../shared is absent";
  }
  const Json manifest = read_json(corpus() / "manifest.json");
  int models = 0;
  for (const Json& entry : manifest.at("files")) {
    const std::string file = entry.at("file");
    if (!file.starts_with("2d/")) continue;
    SCOPED_TRACE(file);
    ++models;
    const Pslg pslg = read_pslg(read_json(corpus() / file));
    const bool real = file.starts_with("2d/r");
    const bool attributes_differ = file.find("yinyang") != std::string::npos;

    ExecutionContext context;
    const auto valid = validate_pslg(pslg, context);
    ASSERT_TRUE(valid) << valid.error().message;

    MeshOptions options;
    if (real) options.symmetry_tolerance_rel = 2e-4;
    options.ignore_markers = attributes_differ;
    // A plain annulus of two unequal polygons: within the tolerance every fold fits it alike, so
    // none is taken unless declared.
    if (file.find("codewheel") != std::string::npos) options.fold = 10;
    const auto inspection = inspect_pslg(pslg, options, context);
    ASSERT_TRUE(inspection) << inspection.error().message;
    EXPECT_EQ(inspection->fold, entry.at("fold").get<int>());
    EXPECT_NEAR(inspection->area, entry.at("area").get<double>(),
                1e-10 * entry.at("area").get<double>());
    EXPECT_EQ(inspection->components, entry.at("components").get<std::size_t>());
    // The manifest's angles count the unmeshed side as well, and have three decimals.
    EXPECT_GE(inspection->min_input_angle_deg,
              entry.at("min_input_angle_deg").get<double>() - 1e-3);
    const Point2 center{entry["axis"]["origin"][0], entry["axis"]["origin"][1]};
    EXPECT_LE(distance(inspection->centre, center),
              (real ? 1e-4 : 1e-12) * inspection->diameter + 1e-15 * length(center));
    EXPECT_LE(inspection->symmetry_error_rel, real ? 2e-4 : 1e-12);

    const auto symmetric = symmetrise(pslg, options, context);
    ASSERT_TRUE(symmetric) << symmetric.error().message;
    EXPECT_EQ(symmetric->fold, entry.at("fold").get<int>());
    expect_symmetric_invariants(*symmetric, pslg);

    options.ignore_markers = false;
    options.fold = 1;
    const auto plain = symmetrise(pslg, options, context);
    ASSERT_TRUE(plain) << plain.error().message;
    expect_symmetric_invariants(*plain, pslg);
    EXPECT_EQ(plain->symmetry_error_rel, 0);
  }
  EXPECT_GE(models, 16);
}

TEST(SharedData, RegionAttributesThatSwapForbidTheFold) {
  const auto path = corpus() / "2d" / "p2_08_yinyang_n2_segment_through_centre.json";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "../shared is absent";
  const Pslg pslg = read_pslg(read_json(path));
  ExecutionContext context;
  MeshOptions options;
  const auto detected = symmetrise(pslg, options, context);
  ASSERT_TRUE(detected) << detected.error().message;
  EXPECT_EQ(detected->fold, 1);
  options.fold = 2;
  const auto declared = symmetrise(pslg, options, context);
  ASSERT_FALSE(declared);
  EXPECT_EQ(declared.error().code, ErrorCode::kNotSymmetric);
  EXPECT_NE(declared.error().message.find("ignore_markers"), std::string::npos)
      << declared.error().message;
}

struct BadCase {
  const char* file;
  ErrorCode code;
};

TEST(SharedData, BadPlaneModelsAreRefusedWithTheRightCode) {
  if (!std::filesystem::exists(corpus() / "bad")) GTEST_SKIP() << "../shared is absent";
  constexpr BadCase kCases[] = {
      {"b03_bowties_self_intersecting", ErrorCode::kSelfIntersection},
      {"b06_index_out_of_range", ErrorCode::kIndexOutOfRange},
      {"b07_index_negative", ErrorCode::kIndexOutOfRange},
      {"b08_duplicate_vertex", ErrorCode::kDuplicateVertices},
      {"b09_zero_length_segments", ErrorCode::kZeroLengthSegment},
      {"b15_all_collinear", ErrorCode::kDegenerateGeometry},
      {"b17_coords_1e308", ErrorCode::kCoordinateRange},
  };
  for (const BadCase& bad : kCases) {
    SCOPED_TRACE(bad.file);
    const Pslg pslg = read_pslg(read_json(corpus() / "bad" / (std::string(bad.file) + ".json")));
    ExecutionContext context;
    const auto valid = validate_pslg(pslg, context);
    ASSERT_FALSE(valid);
    EXPECT_EQ(valid.error().code, bad.code) << valid.error().message;
    EXPECT_FALSE(valid.error().elements.empty() && bad.code != ErrorCode::kDegenerateGeometry);
  }
}

TEST(SharedData, DeclaredFoldsThatDoNotHoldAreRefused) {
  if (!std::filesystem::exists(corpus() / "bad")) GTEST_SKIP() << "../shared is absent";
  const std::pair<const char*, int> cases[] = {{"b01_star5_declared_6.json", 6},
                                               {"b02_one_vertex_moved.json", 8}};
  for (const auto& [file, fold] : cases) {
    SCOPED_TRACE(file);
    const Pslg pslg = read_pslg(read_json(corpus() / "bad" / file));
    ExecutionContext context;
    MeshOptions options;
    options.fold = fold;
    options.center = Point2{0, 0};
    ASSERT_TRUE(validate_pslg(pslg, context));
    const auto result = symmetrise(pslg, options, context);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::kNotSymmetric);
    EXPECT_EQ(result.error().elements.size(), 1U);
    EXPECT_NE(result.error().message.find("worst at vertex"), std::string::npos)
        << result.error().message;
  }
}

}  // namespace
}  // namespace symcell::plane
