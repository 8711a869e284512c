// Flips back to Delaunay.
#include "core/solid/delaunay/legalise.hpp"

#include <gtest/gtest.h>

#include "core/solid/refine/refiner.hpp"
#include "tests/unit/core/solid/solid_checks.hpp"

namespace symcell::solid {
namespace {

class SolidLegalise : public testing::TestWithParam<std::int32_t> {};

INSTANTIATE_TEST_SUITE_P(Folds, SolidLegalise, testing::Values(1, 2, 3, 6, 12));

TEST_P(SolidLegalise, UndoesRandomFlips) {
  test::PrismShape s = test::prism_shape(GetParam());
  s.inner_facet = true;
  s.rings = 3;
  s.layers = 4;
  s.swirl = 0.1;
  auto solid = test::prism(s);
  const double volume = test::quotient_volume(solid.mesh);
  ExecutionContext context;
  test::jitter(solid.mesh, 0.2, 2);
  ASSERT_GT(test::random_flips(solid.mesh, 300, 1), 0);
  Editor editor(solid.mesh);
  const std::uint64_t before = count_illegal(editor);
  EXPECT_GT(before, 0U);
  const auto flips = legalise(editor, context);
  ASSERT_TRUE(flips);
  EXPECT_GT(*flips, 0U);
  EXPECT_EQ(editor.counters().flips, *flips);
  EXPECT_TRUE(test::is_valid(solid.mesh, volume));
  const std::uint64_t after = count_illegal(editor);
  EXPECT_LE(4 * after, before);
  const auto report = validate(solid.mesh, ValidationLevel::kDelaunay, volume);
  ASSERT_TRUE(report);
  EXPECT_LE(report->certain_flips, after);
  // Nothing is left to do.
  const auto more = legalise(editor, context);
  ASSERT_TRUE(more);
  EXPECT_LE(*more, 1U);
}

TEST_P(SolidLegalise, LeavesARefinedMeshNearlyAlone) {
  auto solid = test::prism(test::prism_shape(GetParam()));
  const double volume = test::quotient_volume(solid.mesh);
  MeshOptions options;
  options.max_volume = volume / 200;
  Editor editor(solid.mesh);
  const Criteria criteria(solid, options);
  ExecutionContext context;
  ASSERT_TRUE(Refiner(editor, criteria, context).run());
  ASSERT_TRUE(legalise(editor, context));
  EXPECT_TRUE(test::is_valid(solid.mesh, volume));
  EXPECT_LE(50 * count_illegal(editor), solid.mesh.tet_count());
}

TEST(SolidLegaliseLimits, EndsWhenCancelled) {
  auto solid = test::prism(test::prism_shape(6));
  Editor editor(solid.mesh);
  ExecutionContext context;
  context.cancel();
  const auto flips = legalise(editor, context);
  ASSERT_FALSE(flips);
  EXPECT_EQ(flips.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace symcell::solid
