// Laws of the solid pipeline over random symmetric PLCs. A failure names its seed; run it again
// with SYMCELL_PROPERTY_SEED, or thousands with SYMCELL_PROPERTY_RUNS.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/property/random_case.hpp"
#include "tests/property/solid_case.hpp"
#include "tests/property/solid_laws.hpp"
#include "tests/support/random_plc.hpp"

namespace symcell {
namespace {

SolidCase solid_case(std::uint64_t seed) {
  return make_solid_case(seed, test::make_random_plc(seed));
}

void expect_all_laws(const SolidCase& c) {
  const auto outcome = mesh(c);
  if (!outcome) {
    ADD_FAILURE() << c << "\n"
                  << error_code_name(outcome.error().code) << ": " << outcome.error().message;
    return;
  }
  EXPECT_EQ(outcome->mesh.fold % c.model.fold, 0) << c;
  for (const std::string& law : broken_solid_laws(c.model, c.options, *outcome)) {
    ADD_FAILURE() << c << "\n" << law;
  }
}

TEST(MeshSolidProperty, MeshesKeepAllLaws) {
  const SeedRange seeds = property_seeds(60);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed)
    expect_all_laws(solid_case(seed));
}

// Narrow sectors with acute facets, where points for shape once caused others without end.
TEST(MeshSolidProperty, CascadesThatOnceDidNotEnd) {
  for (const std::uint64_t seed : {290, 320, 491}) expect_all_laws(solid_case(seed));
}

// A volume bound that mending the ratio once broke when no refinement followed.
TEST(MeshSolidProperty, LastMendKeepsTheVolumeBound) {
  expect_all_laws(solid_case(1499));
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

TEST(MeshSolidProperty, SameInputGivesSameBytes) {
  const SeedRange seeds = property_seeds(4);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    const SolidCase c = solid_case(seed);
    const auto first = mesh(c), second = mesh(c);
    ASSERT_EQ(first.has_value(), second.has_value()) << c;
    if (!first) continue;
    const SymmetryCellMesh& a = first->mesh;
    const SymmetryCellMesh& b = second->mesh;
    EXPECT_TRUE(same_bytes(a.orbit_points, b.orbit_points) && same_bytes(a.nodes, b.nodes) &&
                same_bytes(a.elements, b.elements) && same_bytes(a.regions, b.regions) &&
                same_bytes(a.boundary, b.boundary) &&
                same_bytes(a.boundary_markers, b.boundary_markers) &&
                same_bytes(a.lower_to_higher, b.lower_to_higher))
        << c;
  }
}

}  // namespace
}  // namespace symcell
