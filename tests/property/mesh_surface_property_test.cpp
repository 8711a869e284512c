// Laws of the whole way of random tessellated surfaces: a lawful mesh within the tolerance, or an
// error that a user can do something about. Seeds as in mesh_solid_property_test.cpp.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "tests/property/isolated.hpp"
#include "tests/property/random_case.hpp"
#include "tests/property/surface_case.hpp"
#include "tests/support/random_layers.hpp"
#include "tests/support/random_surface.hpp"
#include "tests/support/touching_bodies.hpp"

namespace symcell {
namespace {

void expect_lawful(const SurfaceCase& c, const MeshedSurface& meshed) {
  for (const std::string& law : broken_surface_laws(c, meshed)) ADD_FAILURE() << c << "\n" << law;
}

TEST(MeshSurfaceProperty, MeshesOrErrorsThatTell) {
  const std::set<ErrorCode> told = {ErrorCode::kNotSymmetric, ErrorCode::kAmbiguousSymmetry,
                                    ErrorCode::kTetrahedralizationFailed,
                                    ErrorCode::kSelfIntersection};
  const SeedRange seeds = property_seeds(12);
  std::uint64_t meshed = 0, failed = 0;
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    const SurfaceCase c = make_surface_case(seed, test::make_random_surface(seed));
    const auto outcome = mesh(c);
    if (outcome) {
      ++meshed;
      expect_lawful(c, *outcome);
      continue;
    }
    EXPECT_TRUE(told.contains(outcome.error().code))
        << c << "\n"
        << error_code_name(outcome.error().code) << ": " << outcome.error().message;
    failed += outcome.error().code == ErrorCode::kTetrahedralizationFailed ? 1 : 0;
  }
  RecordProperty("meshed", static_cast<int>(meshed));
  // What is symmetric within the tolerance can be meshed, but for a rare wide one.
  EXPECT_LE(failed, 1 + meshed / 20);
}

void expect_all_layers_lawful(std::uint64_t usual, bool tabs) {
  test::RandomLayersOptions options;
  options.tabs = tabs;
  const SeedRange seeds = property_seeds(usual);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    const SurfaceCase c = make_surface_case(seed, test::make_random_layer_surface(seed, options));
    const auto broken = judged_in_child([&]() -> std::vector<std::string> {
      const auto outcome = mesh(c);
      if (outcome) return broken_surface_laws(c, *outcome);
      return {std::string(error_code_name(outcome.error().code)) + ": " + outcome.error().message};
    });
    for (const std::string& law : broken) ADD_FAILURE() << c << "\n" << law;
  }
}

// Walls, floors and ceilings are exactly symmetric, however their triangles lie: all can be meshed.
TEST(MeshSurfaceProperty, LayersKeepAllLaws) {
  expect_all_layers_lawful(20, false);
}

TEST(MeshSurfaceProperty, TabsAndPocketsKeepAllLaws) {
  expect_all_layers_lawful(15, true);
}

// However their corners were rounded: one solid where faces touch, several where edges or corners do.
TEST(MeshSurfaceProperty, BodiesThatTouchKeepAllLaws) {
  const SeedRange seeds = property_seeds(15);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    const SurfaceCase c = make_surface_case(seed, test::make_touching_bodies(seed));
    const auto outcome = mesh(c);
    ASSERT_TRUE(outcome) << c << "\n" << outcome.error().message;
    expect_lawful(c, *outcome);
  }
}

}  // namespace
}  // namespace symcell
