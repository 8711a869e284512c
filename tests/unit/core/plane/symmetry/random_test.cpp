// Symmetrisation of models whose fold, centre and area are known by construction.
#include <gtest/gtest.h>

#include "core/plane/input/validate_pslg.hpp"
#include "core/plane/symmetry/symmetrise.hpp"
#include "tests/support/pslg_builders.hpp"
#include "tests/support/symmetry_checks.hpp"

namespace symcell::plane {
namespace {

constexpr std::int32_t kFolds[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 17, 24, 36, 72, 100};

TEST(RandomPslg, IsValidWithTheAreaItTells) {
  for (const std::int32_t fold : kFolds) {
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      RandomPslgTraits traits;
      const Pslg pslg = random_symmetric_pslg(seed, fold, &traits);
      ExecutionContext context;
      const auto valid = validate_pslg(pslg, context);
      ASSERT_TRUE(valid) << valid.error().message;
      MeshOptions options;
      options.fold = 1;
      const auto inspection = inspect_pslg(pslg, options, context);
      ASSERT_TRUE(inspection) << inspection.error().message;
      EXPECT_NEAR(inspection->area, traits.area, 1e-10 * traits.area);
    }
  }
}

TEST(RandomPslg, FoldAndCentreAreFound) {
  for (const std::int32_t fold : kFolds) {
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      RandomPslgTraits traits;
      const Pslg pslg = random_symmetric_pslg(seed, fold, &traits);
      ExecutionContext context;
      const auto found = symmetrise(pslg, {}, context);
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_EQ(found->fold, fold);
      EXPECT_LE(found->symmetry_error_rel, 1e-13);
      if (fold > 1) {
        EXPECT_LE(distance(found->centre, traits.center), 1e-12 * found->diameter);
      }
      expect_symmetric_invariants(*found, pslg);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(RandomPslg, DeclaredFoldCentreAndDivisorsAreTaken) {
  for (const std::int32_t fold : {2, 6, 12, 36}) {
    for (std::uint64_t seed = 100; seed < 120; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      RandomPslgTraits traits;
      const Pslg pslg = random_symmetric_pslg(seed, fold, &traits);
      ExecutionContext context;
      MeshOptions options;
      options.center = traits.center;
      for (std::int32_t divisor = 1; divisor <= fold; ++divisor) {
        if (fold % divisor != 0) continue;
        options.fold = divisor;
        const auto found = symmetrise(pslg, options, context);
        ASSERT_TRUE(found) << found.error().message;
        EXPECT_EQ(found->fold, divisor);
        EXPECT_EQ(found->centre, traits.center);
        expect_symmetric_invariants(*found, pslg);
      }
      options.fold = fold + 1;
      const auto wrong = symmetrise(pslg, options, context);
      ASSERT_FALSE(wrong);
      EXPECT_EQ(wrong.error().code, ErrorCode::kNotSymmetric);
    }
  }
}

}  // namespace
}  // namespace symcell::plane
