// Models that are symmetric in shape only: their folds and the outlines that are chosen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/rotation.hpp"
#include "core/plane/input/validate_pslg.hpp"
#include "core/plane/symmetry/symmetrise.hpp"
#include "tests/support/pslg_builders.hpp"
#include "tests/support/shape_models.hpp"

namespace symcell::plane {
namespace {

using test::add_loop;
using test::polygon;

Result<SymmetricPslg> run(const Pslg& pslg, const MeshOptions& options) {
  ExecutionContext context;
  const auto valid = validate_pslg(pslg, context);
  EXPECT_TRUE(valid) << valid.error().message;
  return symmetrise(pslg, options, context);
}

MeshOptions within(double tolerance) {
  MeshOptions options;
  options.symmetry_tolerance_rel = tolerance;
  return options;
}

std::size_t vertices_of(const SymmetricPslg& pslg) {
  return pslg.orbit_points.size() * static_cast<std::size_t>(pslg.fold);
}

// Circles of 64 and 32 sides, out of phase with six holes that all lie the same way.
Pslg flange_out_of_phase() {
  Pslg pslg;
  add_loop(pslg, polygon(64, 10, 0, {}), 1);
  add_loop(pslg, polygon(32, 3, 0, {}), 2);
  pslg.holes.push_back({0, 0});
  for (int i = 0; i < 6; ++i) {
    const double angle = std::numbers::pi / 3 * i;
    const Point2 centre{6.5 * std::cos(angle), 6.5 * std::sin(angle)};
    add_loop(pslg, polygon(16, 1, 0, centre), 3);
    pslg.holes.push_back(centre);
  }
  return pslg;
}

Pslg nut(std::int32_t bore) {
  Pslg pslg;
  add_loop(pslg, polygon(6, 10, 0, {}), 0);
  add_loop(pslg, polygon(bore, 5, 0, {}), 0);
  pslg.holes.push_back({0, 0});
  return pslg;
}

TEST(Shape, CirclesOutOfPhaseAreCutAnew) {
  const Pslg pslg = flange_out_of_phase();
  const auto found = run(pslg, within(1e-3));
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->fold, 6);
  EXPECT_LE(vertices_of(*found), pslg.vertices.size() + 24);
  EXPECT_GE(vertices_of(*found), pslg.vertices.size() - 40);
  EXPECT_LE(found->symmetry_error_rel, 1e-3);
  EXPECT_GT(found->shape_tolerance_rel, 0);
}

TEST(Shape, VerticesAreKeptOnRequest) {
  const Pslg pslg = flange_out_of_phase();
  MeshOptions options = within(1e-3);
  options.keep_vertices = true;
  const auto found = run(pslg, options);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->fold, 6);
  EXPECT_GT(vertices_of(*found), 2 * pslg.vertices.size());
}

TEST(Shape, NoTwoVerticesComeNearerThanOneSectorAsks) {
  const auto found = run(nut(25), within(2e-3));
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->fold, 6);
  const double side = 10 * std::sin(std::numbers::pi / 25);
  const RotationTable rotations(found->fold);
  for (const SymmetricSegment& s : found->segments) {
    const auto place = [&](OrbitVertex v) {
      return rotations.rotate(found->orbit_points[static_cast<std::size_t>(v.orbit)], v.exponent);
    };
    EXPECT_GE(distance(place(s.a), place(s.b)), 0.7 * side);
  }
}

TEST(Shape, ALargerToleranceLosesNoFold) {
  for (const double tolerance : {2e-3, 3e-3, 5e-3, 7.9e-3, 1e-2, 3e-2, 0.1}) {
    SCOPED_TRACE(tolerance);
    const auto found = run(nut(25), within(tolerance));
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->fold % 6, 0) << found->fold;
    const auto teeth = run(gear(17, 2, 1.95, 0.4), within(tolerance));
    ASSERT_TRUE(teeth);
    EXPECT_EQ(teeth->fold % 17, 0) << teeth->fold;
  }
}

TEST(Shape, NearFoldsAreTold) {
  const auto found = run(flange_out_of_phase(), within(2e-4));
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_FALSE(found->warnings.empty());
  const Warning& warning = found->warnings.front();
  EXPECT_EQ(warning.code, WarningCode::kNearSymmetry);
  ASSERT_TRUE(warning.near_fold);
  EXPECT_EQ(warning.near_fold->fold, 6);
  EXPECT_EQ(run(flange_out_of_phase(), within(warning.near_fold->tolerance_rel))->fold, 6);
}

// Magnets that alternate: four sectors alike, but for what they are called.
Pslg magnets() {
  SectorBuilder builder(4);
  const auto inner = builder.add_vertex({1, 0}), outer = builder.add_vertex({2, 0});
  builder.add_loop({inner}, 0);
  builder.add_loop({outer}, 0);
  builder.add_segment(inner, outer, 0);
  Pslg pslg = builder.pslg();
  pslg.holes.push_back({0, 0});
  for (std::int32_t k = 0; k < 4; ++k) {
    pslg.regions.push_back(
        {builder.turned({1, 0.9}, k), k % 2 + 1, std::numeric_limits<double>::infinity()});
  }
  return pslg;
}

TEST(Shape, AttributesThatBreakAFoldAreNamed) {
  const auto found = run(magnets(), {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->fold, 2);
  EXPECT_EQ(found->geometry_fold, 4);
  ASSERT_EQ(found->warnings.size(), 1U);
  EXPECT_EQ(found->warnings[0].code, WarningCode::kMarkersBreakSymmetry);
  EXPECT_NE(found->warnings[0].mend.find("ignore_markers"), std::string::npos);
  MeshOptions four;
  four.fold = 4;
  const auto refused = run(magnets(), four);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("ignore_markers"), std::string::npos);
  EXPECT_EQ(refused.error().message.find("vertex"), std::string::npos) << refused.error().message;
  EXPECT_EQ(refused.error().pointer.substr(0, 10), "/segments/");
  four.ignore_markers = true;
  EXPECT_TRUE(run(magnets(), four));
}

TEST(Shape, AFoldIsFoundAtAnyTolerance) {
  const Pslg ring = test::wavy_ring();
  for (const double tolerance : {1e-6, 1e-4, 1e-3, 1e-2, 0.1}) {
    SCOPED_TRACE(tolerance);
    ExecutionContext context;
    const auto found = inspect_pslg(ring, within(tolerance), context);
    ASSERT_TRUE(found) << found.error().message;
    // 2,000 vertices do not repeat seven times, unless some are moved by a share of their distance.
    EXPECT_EQ(found->fold, tolerance < 1e-5 ? 1 : 7);
  }
}

}  // namespace
}  // namespace symcell::plane
