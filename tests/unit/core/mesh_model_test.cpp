// From a model to its mesh, through all stages.
#include "core/mesh_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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
  TriangleSurface cubes = box_surface({0, 0, 0}, {1, 1, 1});
  append(cubes, box_surface({1, 1, 1}, {2, 2, 2}));
  ExecutionContext context;
  MeshOptions options;
  const auto chosen = mesh_model(cubes, options, context);
  ASSERT_TRUE(chosen) << chosen.error().message;
  EXPECT_EQ(chosen->statistics.symmetry.fold, 1);
  EXPECT_NEAR(chosen->statistics.cell.measure, 2, 1e-12);
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

}  // namespace
}  // namespace symcell
