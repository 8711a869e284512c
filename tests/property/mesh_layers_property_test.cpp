// Laws of the solid pipeline over random stacks of prisms: facets with several holes, islands and
// gaps with material beyond, coplanar neighbours, edges that end inside others. As facets here, as
// triangles in mesh_surface_property_test.cpp. Seeds as in mesh_solid_property_test.cpp.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/property/isolated.hpp"
#include "tests/property/random_case.hpp"
#include "tests/property/solid_case.hpp"
#include "tests/property/solid_laws.hpp"
#include "tests/support/random_layers.hpp"

namespace symcell {
namespace {

std::vector<std::string> broken_laws(const SolidCase& c) {
  const auto outcome = mesh(c);
  if (!outcome) {
    return {std::string(error_code_name(outcome.error().code)) + ": " + outcome.error().message};
  }
  std::vector<std::string> broken = broken_solid_laws(c.model, c.options, *outcome);
  if (outcome->mesh.fold % c.model.fold != 0) {
    broken.push_back("fold: " + std::to_string(outcome->mesh.fold));
  }
  return broken;
}

void expect_all_laws(std::uint64_t seed, bool tabs) {
  test::RandomLayersOptions options;
  options.tabs = tabs;
  const SolidCase c = make_solid_case(seed, test::make_random_layers(seed, options));
  for (const std::string& law : judged_in_child([&] { return broken_laws(c); })) {
    ADD_FAILURE() << c << "\n" << law;
  }
}

TEST(MeshLayersProperty, MeshesKeepAllLaws) {
  const SeedRange seeds = property_seeds(40);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) expect_all_laws(seed, false);
}

// The faces that tabs and pockets stand in have holes, with material beyond them.
TEST(MeshLayersProperty, TabsAndPocketsKeepAllLaws) {
  const SeedRange seeds = property_seeds(25);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) expect_all_laws(seed, true);
}

}  // namespace
}  // namespace symcell
