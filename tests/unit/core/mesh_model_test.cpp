// From a model to its mesh, through all stages.
#include "core/mesh_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "core/geometry/rotation.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell {
namespace {

// Long thin triangles of a thin ring: two thirds of such cells were over the ratio.
TEST(MeshModel, AThinRingOfManySidesKeepsItsBounds) {
  const TriangleSurface ring = ring_surface(120, 10, 9.7, 6);
  for (const std::int32_t fold : {1, 4}) {
    ExecutionContext context;
    MeshOptions options;
    options.fold = fold;
    const auto outcome = mesh_model(ring, options, context);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_TRUE(outcome->statistics.exempt.empty()) << fold;
    EXPECT_GT(outcome->statistics.cell.min_dihedral_deg, 15) << fold;
  }
}

TEST(MeshModel, StatisticsOfATubeListTheFolds) {
  constexpr std::int32_t kSides = 120;
  const TriangleSurface tube = ring_surface(kSides, 10, 8, 6);
  ExecutionContext context;
  MeshOptions options;
  const auto chosen = mesh_model(tube, options, context);
  ASSERT_TRUE(chosen) << chosen.error().message;
  options.largest_fold = true;
  const auto largest = mesh_model(tube, options, context);
  ASSERT_TRUE(largest) << largest.error().message;
  EXPECT_EQ(largest->statistics.symmetry.fold, kSides);
  EXPECT_TRUE(largest->statistics.symmetry.candidates.empty());
  EXPECT_LT(chosen->statistics.symmetry.fold, kSides);
  EXPECT_TRUE(chosen->statistics.symmetry.detected);
  EXPECT_LT(chosen->statistics.cell.elements, largest->statistics.cell.elements);
  ASSERT_FALSE(chosen->statistics.symmetry.candidates.empty());
  EXPECT_EQ(chosen->statistics.symmetry.candidates.front().fold, kSides);
}

// Two cubes that share a corner have fold 3 about their diagonal, and no sector of it has a cut that
// is closed.
TEST(MeshModel, TakesADivisorWhereTheFoldHasNoMesh) {
  // Cubes that overlap at a corner by so little that no cut about their diagonal is found.
  const auto cube = [](double low, double high) {
    TriangleSurface s;
    for (const double z : {low, high}) {
      for (const auto& [x, y] : {std::pair(low, low), {high, low}, {high, high}, {low, high}}) {
        s.vertices.push_back({x, y, z});
      }
    }
    s.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                   {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    return s;
  };
  TriangleSurface cubes = cube(0, 1);
  append(cubes, cube(1 - 3e-5, 2 - 3e-5));
  ExecutionContext context;
  MeshOptions options;
  const auto chosen = mesh_model(cubes, options, context);
  ASSERT_TRUE(chosen) << chosen.error().message;
  EXPECT_EQ(chosen->statistics.symmetry.fold, 1);
  EXPECT_NEAR(chosen->statistics.cell.measure, 2, 1e-4);
  const auto& warnings = chosen->statistics.warnings;
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const Warning& w) {
    return w.code == WarningCode::kFoldNotLargest &&
           w.text.find("at fold 3 there is no mesh") != std::string::npos;
  }));
  options.strict = true;
  EXPECT_FALSE(mesh_model(cubes, options, context));
  options = {};
  options.fold = 3;
  EXPECT_FALSE(mesh_model(cubes, options, context));
}

double shortest_edge(const SymmetryCellMesh& mesh) {
  const RotationTable turns(mesh.fold);
  double least = kInfinity;
  for (std::size_t e = 0; e < mesh.elements.size(); e += 4) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        const auto place = [&](std::size_t c) {
          const OrbitVertex node = mesh.nodes[static_cast<std::size_t>(mesh.elements[e + c])];
          return turns.rotate(mesh.orbit_points[static_cast<std::size_t>(node.orbit)],
                              node.exponent);
        };
        least = std::min(least, distance(place(i), place(j)));
      }
    }
  }
  return least;
}

std::uint64_t exempt_of(const MeshOutcome& outcome, const std::string& reason) {
  for (const ExemptCount& e : outcome.statistics.exempt) {
    if (e.reason == reason) return e.elements;
  }
  return 0;
}

// Solids whose own edges are longer: none of the mesh is shorter than asked for.
TEST(MeshModel, NoEdgeOfASolidIsShorterThanTheLeast) {
  for (const std::int32_t fold : {1, 4}) {
    for (const bool plain : {false, true}) {
      for (const double least : {0.1, 0.2, 0.3}) {
        ExecutionContext context;
        MeshOptions options;
        options.fold = fold;
        options.plain = plain;
        options.max_edge = 0.7;
        options.radius_edge = 1.1;
        options.min_edge = least;
        const auto outcome = mesh_model(box_surface({0, 0, 0}, {1, 1, 2}), options, context);
        ASSERT_TRUE(outcome) << outcome.error().message;
        EXPECT_NEAR(outcome->statistics.cell.measure, 2.0 / fold, 1e-9);
        EXPECT_GE(shortest_edge(outcome->mesh), least) << fold << plain;
      }
    }
  }
}

// Bounds that would take shorter edges end as exempt, not as an error.
TEST(MeshModel, LeastEdgesOfSolidsEndWhatBoundsAskFor) {
  ExecutionContext context;
  MeshOptions options;
  options.max_volume = 1e-4;
  options.min_edge = 0.3;
  const auto outcome = mesh_model(box_surface({0, 0, 0}, {1, 1, 2}), options, context);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_GT(exempt_of(*outcome, "min_edge"), 0U);
  EXPECT_GE(shortest_edge(outcome->mesh), 0.3);
}

// Plates and rods much thinner than the tolerance, which is a share of their length: their thickness is
// no flaw to be mended, and the tolerance leaves room for no other cut than the right one.
class ThinSurface : public testing::TestWithParam<std::tuple<bool, double, std::int32_t>> {};

TEST_P(ThinSurface, KeepsItsVolumeAndItsFold) {
  const auto [is_rod, thickness, sides] = GetParam();
  const TriangleSurface surface = is_rod ? box_surface({-0.5 * thickness, -0.5 * thickness, 0},
                                                       {0.5 * thickness, 0.5 * thickness, 1})
                                         : ring_surface(sides, 1, 0.5, thickness);
  const std::int32_t fold = is_rod ? 4 : sides;
  const double angle = 2 * std::numbers::pi / sides;
  const double volume =
      is_rod ? thickness * thickness : 0.5 * sides * std::sin(angle) * (1 - 0.25) * thickness;
  MeshOptions options;
  options.plain = true;
  options.fold = fold;
  options.axis_origin = Point3{0, 0, 0};
  options.axis_direction = Point3{0, 0, 1};
  ExecutionContext context;
  const auto outcome = mesh_model(surface, options, context);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_NEAR(fold * outcome->statistics.cell.measure, volume, 1e-3 * volume);
  options = {};
  const auto inspected = inspect_model(surface, options, context);
  ASSERT_TRUE(inspected) << inspected.error().message;
}

INSTANTIATE_TEST_SUITE_P(Samples,
                         ThinSurface,
                         testing::Combine(testing::Bool(),
                                          testing::Values(1e-5, 1e-4, 1e-3, 1e-2),
                                          testing::Values(4, 6)));

}  // namespace
}  // namespace symcell
