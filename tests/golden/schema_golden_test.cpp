// The documents of statistics and inspections, for models of every kind.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "api/schema/statistics_json.hpp"
#include "tests/golden/golden.hpp"

namespace symcell {
namespace {

using test::expect_golden;

// All but the version, which changes with every release.
std::string text_of(nlohmann::ordered_json document) {
  EXPECT_TRUE(document.contains("version"));
  document.erase("version");
  return document.dump(1) + "\n";
}

Statistics sample_statistics() {
  Statistics s;
  s.cell = {.elements = 10,
            .nodes = 8,
            .symmetry_nodes = 3,
            .symmetry_facets = 2,
            .measure = 0.25,
            .min_angle_deg = 31.5,
            .max_angle_deg = 104,
            .max_radius_edge = 1.25,
            .min_dihedral_deg = 22.5,
            .max_dihedral_deg = 140,
            .aspect_ratio_histogram = {1, 2, 3, 4, 0, 0, 0, 0, 0}};
  s.full = {.elements = 40, .nodes = 20};
  s.symmetry = {.fold = 4,
                .axis_origin = {0.5, 0.5, 0},
                .axis_direction = {0, 0, 1},
                .error_rel = 1e-9,
                .detected = true,
                .candidates = {}};
  s.refinement = {.steiner_points = 5, .splits = 2, .flips = 30, .crossings = 4};
  s.exempt = {{"small_input_angle", 1}};
  s.warnings = {near_symmetry_warning({12, 1.06e-3, 1.1e-3}, 4, 1e-3),
                *exempt_elements_warning(s.exempt, s.cell.elements)};
  s.repairs = {"1,234 triangles turned round: the surface was inside out"};
  s.delaunay = false;
  s.timings_ms = {
      .parse = 1, .symmetry = 2, .initial = 3, .refine = 4, .cell = 5, .check = 6, .total = 21};
  s.peak_memory_bytes = 1048576;
  return s;
}

TEST(Golden, StatisticsOfEachKind) {
  expect_golden("statistics_pslg.json",
                text_of(statistics_to_json(sample_statistics(), {}, ModelKind::kPslg)));
  MeshOptions options;
  options.fold = 4;
  options.axis_origin = Point3{0.5, 0.5, 0};
  options.max_volume = 0.125;
  Statistics solid = sample_statistics();
  solid.symmetry.candidates = {{8, 120, true}, {4, 10, true}, {2, 19.6, false}};
  expect_golden("statistics_surface.json",
                text_of(statistics_to_json(solid, options, ModelKind::kSurface)));
}

TEST(Golden, InspectionOfEachKind) {
  PslgInspection planar;
  planar.fold = 4;
  planar.centre = {0.5, 0.5};
  planar.area = 1;
  planar.diameter = 1.5;
  planar.bbox_max = {1, 1};
  planar.vertices = 4;
  planar.segments = 4;
  planar.components = 1;
  planar.min_input_angle_deg = 90;
  planar.folds = {{2, 0, true, Point3{1, 0, 0}}, {3, 0.25, false}, {4, 0, true}};
  planar.warnings = {no_symmetry_warning(1e-6)};
  expect_golden("inspection_pslg.json", text_of(inspection_to_json(planar)));

  SolidInspection plc;
  plc.kind = "plc";
  plc.fold = 4;
  plc.axis_origin = {0.5, 0.5, 0};
  plc.diameter = 1.75;
  plc.bbox_max = {1, 1, 1};
  plc.vertices = 8;
  plc.facets = 6;
  plc.holes = 1;
  plc.regions = 2;
  plc.folds = planar.folds;
  plc.warnings = {axis_ambiguous_warning(4, {0.5, 0.5, 0}, {0, 0, 1})};
  expect_golden("inspection_plc.json", text_of(inspection_to_json(plc)));

  SolidInspection surface = plc;
  surface.kind = "surface";
  surface.symmetry_error_rel = 1e-4;
  surface.volume = 1;
  surface.surface_area = 6;
  surface.watertight = false;
  surface.facets = 11;
  surface.shells = 1;
  surface.repairs = {"2 vertices welded"};
  surface.warnings = {surface_repaired_warning(surface.repairs),
                      fold_not_largest_warning(4, 12, "it fits exactly")};
  surface.problem = "the surface is open: 3 edges have one triangle";
  expect_golden("inspection_surface.json", text_of(inspection_to_json(surface)));
}

}  // namespace
}  // namespace symcell
