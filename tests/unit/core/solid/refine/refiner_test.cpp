// Bounds kept on prisms of many folds, limits, determinism, depth.
#include "core/solid/refine/refiner.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "tests/unit/core/solid/solid_checks.hpp"

namespace symcell::solid {
namespace {

struct Job {
  InitialTetrahedralization solid;
  MeshOptions options;
  double volume = 0;
  RefineCounters counters;
  std::size_t bad = 0, oversized = 0;

  Job(const test::PrismShape& shape, double share) : solid(test::prism(shape)) {
    volume = test::quotient_volume(solid.mesh);
    if (share > 0) options.max_volume = share * volume;
  }
  Result<void> refine(ExecutionContext& context, int depth = Refiner::kMaxChain) {
    Editor editor(solid.mesh);
    const Criteria criteria(solid, options);
    Refiner refiner(editor, criteria, context);
    refiner.set_max_depth(depth);
    auto done = refiner.run();
    counters = refiner.counters();
    bad = test::count_bad(editor, criteria);
    oversized = test::count_bad(editor, criteria, false);
    return done;
  }
};

class SolidRefinerPrisms : public testing::TestWithParam<std::tuple<std::int32_t, double, double>> {
};

INSTANTIATE_TEST_SUITE_P(FoldsBoresVolumes,
                         SolidRefinerPrisms,
                         testing::Combine(testing::Values(1, 2, 3, 6, 12, 64),
                                          testing::Values(0.0, 0.8),
                                          testing::Values(0.0, 0.02, 0.003)));

TEST_P(SolidRefinerPrisms, KeepsTheBounds) {
  const auto [fold, bore, share] = GetParam();
  Job run(test::prism_shape(fold, bore), share);
  ExecutionContext context;
  ASSERT_TRUE(run.refine(context));
  EXPECT_TRUE(test::is_valid(run.solid.mesh, run.volume));
  EXPECT_EQ(run.oversized, 0U);
  // What is still bad was refused a point: little, but in narrow sectors, where copies are near.
  EXPECT_LE(run.bad, run.counters.refused);
  const double share_of_bad =
      static_cast<double>(run.bad) / static_cast<double>(run.solid.mesh.tet_count());
  // At an axis it leaves the most to improvement.
  const double narrow_share = bore > 0 ? 0.1 : 0.15;
  EXPECT_LE(share_of_bad, fold <= 3 ? 0 : (fold <= 12 ? narrow_share : 0.25));
  if (share > 0) {
    EXPECT_GE(static_cast<double>(run.solid.mesh.tet_count()), 1 / share);
  }
}

TEST(SolidRefiner, KeepsTheBoundsOfRegions) {
  test::PrismShape s = test::prism_shape(6);
  s.inner_facet = true;
  Job run(s, 0);
  run.solid.subdomains[1].max_volume = 0.004 * run.volume;
  ExecutionContext context;
  ASSERT_TRUE(run.refine(context));
  EXPECT_TRUE(test::is_valid(run.solid.mesh, run.volume));
  EXPECT_EQ(run.oversized, 0U);
  std::size_t count[2] = {0, 0};
  for (TetId t = 0; t < run.solid.mesh.tet_slots(); ++t) {
    if (run.solid.mesh.alive(t)) ++count[run.solid.mesh.tet(t).region];
  }
  EXPECT_GT(count[1], 2 * count[0]);
}

TEST(SolidRefiner, KeepsTheLongestEdge) {
  Job run(test::prism_shape(6), 0);
  run.options.max_edge = 0.4;
  ExecutionContext context;
  ASSERT_TRUE(run.refine(context));
  EXPECT_TRUE(test::is_valid(run.solid.mesh, run.volume));
  EXPECT_EQ(run.oversized, 0U);
}

TEST(SolidRefiner, SameBytesTwice) {
  Job a(test::prism_shape(6), 0.005), b(test::prism_shape(6), 0.005);
  ExecutionContext context;
  ASSERT_TRUE(a.refine(context));
  ASSERT_TRUE(b.refine(context));
  EXPECT_EQ(test::fingerprint(a.solid.mesh), test::fingerprint(b.solid.mesh));
}

TEST(SolidRefiner, LimitsEndInTheirCodes) {
  const auto code = [](ExecutionContext& context) {
    Job run(test::prism_shape(6), 0.0005);
    const auto done = run.refine(context);
    EXPECT_TRUE(test::is_valid(run.solid.mesh, run.volume));
    return done ? ErrorCode::kInternal : done.error().code;
  };
  {
    ExecutionContext context;
    context.set_max_elements(300);
    EXPECT_EQ(code(context), ErrorCode::kElementLimit);
  }
  {
    ExecutionContext context;
    context.set_time_limit(1e-9);
    EXPECT_EQ(code(context), ErrorCode::kTimeLimit);
  }
  {
    ExecutionContext context;
    context.cancel();
    EXPECT_EQ(code(context), ErrorCode::kCancelled);
  }
}

// A flat prism: shape asks for many points.
Job flat_prism(double share = 0) {
  test::PrismShape s = test::prism_shape(6);
  s.height = 0.05;
  return Job(s, share);
}

TEST(SolidRefiner, MeshesLargeEnoughGetNoPointsForShape) {
  Job run = flat_prism();
  const std::size_t before = run.solid.mesh.tet_count();
  Editor editor(run.solid.mesh);
  const Criteria criteria(run.solid, run.options);
  ASSERT_GT(test::count_bad(editor, criteria), 0U);
  ExecutionContext context;
  for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{before + 40}}) {
    Refiner refiner(editor, criteria, context);
    refiner.set_most_shaped(most);
    ASSERT_TRUE(refiner.run());
    // One point more than the last that was allowed.
    EXPECT_LE(run.solid.mesh.tet_count(), std::max(most, std::uint64_t{before}) + 60);
    EXPECT_EQ(run.solid.mesh.tet_count() > before, most > 0);
  }
}

TEST(SolidRefiner, PointsForSizeAreNotCapped) {
  Job run = flat_prism(0.001);
  Editor editor(run.solid.mesh);
  const Criteria criteria(run.solid, run.options);
  ExecutionContext context;
  Refiner refiner(editor, criteria, context);
  refiner.set_most_shaped(0);
  ASSERT_TRUE(refiner.run());
  EXPECT_EQ(test::count_bad(editor, criteria, false), 0U);
}

TEST(SolidRefiner, UnwantedSizeEndsTheRun) {
  Job run = flat_prism(0.00001);
  Editor editor(run.solid.mesh);
  const Criteria criteria(run.solid, run.options);
  ExecutionContext context;
  Refiner refiner(editor, criteria, context);
  refiner.set_most_tets(500);
  const auto done = refiner.run();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kElementLimit);
  EXPECT_TRUE(test::is_valid(run.solid.mesh, run.volume));
}

TEST(SolidRefiner, LessDepthMakesFewerPoints) {
  std::size_t vertices[2] = {0, 0};
  const int depths[2] = {0, Refiner::kMaxChain};
  for (std::size_t i = 0; i < 2; ++i) {
    test::PrismShape s = test::prism_shape(6);
    s.height = 0.05;  // flat: shape asks for points nearer than what is there
    Job run(s, 0);
    ExecutionContext context;
    ASSERT_TRUE(run.refine(context, depths[i]));
    EXPECT_TRUE(test::is_valid(run.solid.mesh, run.volume));
    vertices[i] = run.solid.mesh.vertex_slots();
  }
  EXPECT_LE(vertices[0], vertices[1]);
}

}  // namespace
}  // namespace symcell::solid
