#include "api/schema/statistics_json.hpp"

#include <gtest/gtest.h>

namespace symcell {
namespace {

TEST(StatisticsJson, HasEveryNameOfTheInterface) {
  Statistics statistics;
  statistics.cell.elements = 12;
  statistics.cell.measure = 0.5;
  statistics.cell.aspect_ratio_histogram[8] = 3;
  statistics.exempt.push_back({"small_input_angle", 4});
  const auto json = statistics_to_json(statistics, MeshOptions{}, ModelKind::kPslg);
  for (const char* pointer : {"/cell/elements",
                              "/cell/nodes",
                              "/cell/symmetry_nodes",
                              "/cell/symmetry_facets",
                              "/cell/area",
                              "/cell/min_angle_deg",
                              "/cell/max_angle_deg",
                              "/cell/max_radius_edge",
                              "/cell/min_dihedral_deg",
                              "/cell/max_dihedral_deg",
                              "/cell/aspect_ratio_histogram",
                              "/full/elements",
                              "/full/nodes",
                              "/symmetry/fold",
                              "/symmetry/axis/origin",
                              "/symmetry/axis/direction",
                              "/symmetry/error",
                              "/symmetry/detected",
                              "/refinement/steiner_points",
                              "/refinement/splits",
                              "/refinement/flips",
                              "/refinement/crossings",
                              "/exempt/0/reason",
                              "/exempt/0/elements",
                              "/timings_ms/parse",
                              "/timings_ms/symmetry",
                              "/timings_ms/initial",
                              "/timings_ms/refine",
                              "/timings_ms/cell",
                              "/timings_ms/check",
                              "/timings_ms/restore",
                              "/timings_ms/write",
                              "/timings_ms/total",
                              "/peak_memory_bytes",
                              "/settings/min_angle",
                              "/version"}) {
    EXPECT_TRUE(json.contains(nlohmann::ordered_json::json_pointer(pointer))) << pointer;
  }
  EXPECT_EQ(json["cell"]["aspect_ratio_histogram"].size(), 9U);
  EXPECT_EQ(json["cell"]["aspect_ratio_histogram"][8], 3);
  EXPECT_EQ(json["exempt"][0]["elements"], 4);
  EXPECT_FALSE(json["version"].get<std::string>().empty());
}

TEST(StatisticsJson, NumbersThatAreNoneBecomeNull) {
  Statistics statistics;
  statistics.cell.min_angle_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(
      statistics_to_json(statistics, {}, ModelKind::kPslg)["cell"]["min_angle_deg"].is_null());
}

TEST(InspectionJson, TellsSymmetryAndSize) {
  PslgInspection inspection;
  inspection.fold = 6;
  inspection.centre = {1, 2};
  inspection.folds = {{2, 0.0, true}, {6, 1e-9, true}};
  const auto json = inspection_to_json(inspection);
  EXPECT_EQ(json["fold"], 6);
  EXPECT_EQ(json["axis"]["origin"], nlohmann::json({1.0, 2.0, 0.0}));
  EXPECT_EQ(json["folds"][1]["error"], 1e-9);
  EXPECT_TRUE(json.contains("symmetry_error"));
  EXPECT_TRUE(json.contains("area"));
}

}  // namespace
}  // namespace symcell
