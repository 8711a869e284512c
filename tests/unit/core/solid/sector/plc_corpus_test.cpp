// The PLCs of the shared corpus: fold and axis, and the whole surface restored from sectors at all
// angles offered. Skipped where the corpus is not beside the source tree.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/solid/sector/symmetrise.hpp"
#include "tests/support/plc_files.hpp"
#include "tests/support/plc_sector_checks.hpp"
#include "tests/support/test_files.hpp"

namespace symcell::solid {
namespace {

using Json = nlohmann::json;
using test::expect_sound_sector;
using test::read_plc_json;
using test::restore_surface;
using test::RestoredSurface;

double distance_from_axis(Point3 p, const AxisFrame& frame) {
  const Point3 local = frame.to_local(p);
  return length(Point2{local.x, local.y});
}

void expect_sectors(const SectorSource& source, const Json& entry) {
  ExecutionContext context;
  const double volume = entry.at("volume").get<double>();
  std::vector<double> areas;
  double segment_length = 0;
  for (std::int32_t i = 0; i < source.candidates(); ++i) {
    SCOPED_TRACE("candidate " + std::to_string(i));
    const auto sector = source.sector(i, context);
    ASSERT_TRUE(sector) << sector.error().message;
    expect_sound_sector(*sector);
    EXPECT_NEAR(sector->expected_volume, volume, 1e-12 * volume);
    const RestoredSurface surface = restore_surface(*sector);
    EXPECT_EQ(surface.closed,
              entry.at("edges_used_once").get<int>() == 0 && entry.at("regions").get<int>() == 0);
    if (surface.volume != 0) {
      EXPECT_NEAR(surface.volume, volume, 1e-12 * volume);
    }
    if (i == 0) {
      areas = surface.facet_area;
      segment_length = surface.segment_length;
    }
    ASSERT_EQ(surface.facet_area.size(), areas.size());
    for (std::size_t f = 0; f < areas.size(); ++f) {
      EXPECT_NEAR(surface.facet_area[f], areas[f], 1e-12 * areas[f]);
    }
    EXPECT_NEAR(surface.segment_length, segment_length, 1e-12 * segment_length);
  }
}

TEST(SharedData, FoldsAxesAndSectors) {
  const auto shared = test::shared_folder();
  if (!shared) GTEST_SKIP() << "../shared is absent";
  std::ifstream file(*shared / "corpus" / "manifest.json");
  const Json manifest = Json::parse(file);
  int models = 0;
  for (const Json& entry : manifest.at("files")) {
    const std::string name = entry.at("file");
    if (!name.starts_with("3d/p3_")) continue;
    SCOPED_TRACE(name);
    ++models;
    const Plc plc = read_plc_json(*shared / "corpus" / name);
    const auto point = [&](const char* key) {
      const Json& p = entry.at("axis").at(key);
      return Point3{p[0], p[1], p[2]};
    };
    const auto fold = entry.at("fold").get<std::int32_t>();
    ExecutionContext context;

    MeshOptions detect;
    detect.symmetry_tolerance_rel = entry.at("tolerance_needed_relative").get<double>();
    // A cube has more than the manifest says.
    const bool cube = name.find("cube") != std::string::npos;
    auto source = symmetrise_plc(plc, detect, context);
    ASSERT_TRUE(source) << source.error().message;
    const Symmetry& found = (*source)->symmetry();
    EXPECT_EQ(found.fold, cube ? 4 : fold);
    EXPECT_LE(found.error_rel, 1e-12);
    EXPECT_TRUE(found.fold_detected);
    if (!cube) {
      EXPECT_NEAR(std::abs(dot(found.frame.direction(), point("direction"))), 1, 1e-12);
      EXPECT_LE(distance_from_axis(point("origin"), found.frame), 1e-12 * found.diameter);
    }
    expect_sectors(**source, entry);

    MeshOptions fold_given;
    fold_given.fold = fold;
    source = symmetrise_plc(plc, fold_given, context);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ((*source)->symmetry().fold, fold);
    expect_sectors(**source, entry);

    MeshOptions all_given = fold_given;
    all_given.axis_origin = point("origin");
    all_given.axis_direction = point("direction");
    source = symmetrise_plc(plc, all_given, context);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ((*source)->symmetry().frame.origin, point("origin"));
    EXPECT_FALSE((*source)->symmetry().axis_detected);
    expect_sectors(**source, entry);

    MeshOptions whole;
    whole.fold = 1;
    source = symmetrise_plc(plc, whole, context);
    ASSERT_TRUE(source) << source.error().message;
    expect_sectors(**source, entry);
  }
  EXPECT_EQ(models, 8);
}

}  // namespace
}  // namespace symcell::solid
