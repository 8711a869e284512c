// Laws of the planar pipeline over random models cut from grids: combs, gears, nested holes,
// islands, regions that touch, thin webs, segments that end inside others. Seeds as in
// mesh_pslg_property_test.cpp.
#include <gtest/gtest.h>

#include "core/base/execution_context.hpp"
#include "core/mesh_model.hpp"
#include "tests/property/mesh_laws.hpp"
#include "tests/property/random_case.hpp"

namespace symcell {
namespace {

TEST(MeshCellsProperty, MeshesKeepAllLaws) {
  const SeedRange seeds = property_seeds(300);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    RandomCase c = make_random_cells_case(seed);
    const auto run = [&c] {
      ExecutionContext context;
      context.set_max_elements(c.options.max_elements);
      context.set_time_limit(c.options.time_limit_s);
      return mesh_model(c.model, c.options, context);
    };
    auto outcome = run();
    // The laws are of meshes that have all vertices; some cells are symmetric but for these.
    if (outcome && outcome->mesh.shape_tolerance_rel > 0) {
      c.options.keep_vertices = true;
      outcome = run();
    }
    if (!outcome) {
      const ErrorCode code = outcome.error().code;
      const bool excused = !c.must_succeed && (code == ErrorCode::kBoundUnreachable ||
                                               code == ErrorCode::kElementLimit);
      EXPECT_TRUE(excused) << c << "\n" << error_code_name(code) << ": " << outcome.error().message;
      continue;
    }
    EXPECT_EQ(outcome->mesh.fold % c.traits.fold, 0) << c;
    for (const std::string& law :
         broken_laws(c.model, c.traits.area, c.options, *outcome, c.pinches)) {
      ADD_FAILURE() << c << "\n" << law;
    }
  }
}

}  // namespace
}  // namespace symcell
