// The random planar models cut from grids are what they claim: valid, of their area, symmetric.
#include "tests/support/random_planar_cells.hpp"

#include <gtest/gtest.h>

#include <map>

#include "core/plane/symmetry/symmetrise.hpp"

namespace symcell {
namespace {

TEST(RandomPlanarCells, ModelsAreValidAndAsTold) {
  std::map<std::string, int> seen;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const auto model = test::make_random_planar_cells(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + model.description);
    ExecutionContext context;
    MeshOptions options;
    options.fold = model.fold;
    options.center = model.center;
    const auto found = plane::inspect_pslg(model.pslg, options, context);
    if (!found) {
      ADD_FAILURE() << error_code_name(found.error().code) << ": " << found.error().message;
      continue;
    }
    EXPECT_NEAR(found->area, model.area, 1e-9 * model.area);
    EXPECT_EQ(found->fold, model.fold);
    for (const char* word : {"pinched", "divided", "arms", "thin", "fan", "bore", "1-fold cells",
                             "rectangles", "materials"}) {
      if (model.description.find(word) != std::string::npos) ++seen[word];
    }
    if (model.pslg.holes.size() > 1) ++seen["several holes"];
    if (model.boundary.pieces > 2) ++seen["several pieces"];
    if (model.fold > 24) ++seen["many copies"];
  }
  for (const auto& [word, count] : seen) EXPECT_GE(count, 1) << word;
  EXPECT_EQ(seen.size(), 12u);
}

}  // namespace
}  // namespace symcell
