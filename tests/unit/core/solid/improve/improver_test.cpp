// Rounds of improvement: shapes get better, bounds stay, nothing breaks.
#include "core/solid/improve/improver.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/solid/refine/refiner.hpp"
#include "tests/support/solid_sectors.hpp"
#include "tests/unit/core/solid/solid_checks.hpp"

namespace symcell::solid {
namespace {

constexpr double kGoal = 0.5;  // sine of 30 degrees

class SolidImproverFold : public testing::TestWithParam<std::int32_t> {
 protected:
  SolidImproverFold() : solid_(test::prism(test::prism_shape(GetParam()))) {
    volume_ = test::quotient_volume(solid_.mesh);
    options_.max_volume = volume_ / 250;
  }

  void improve(InitialTetrahedralization& solid) {
    Editor editor(solid.mesh);
    const Criteria criteria(solid, options_);
    ExecutionContext context;
    ASSERT_TRUE(Refiner(editor, criteria, context).run());
    ASSERT_TRUE(test::is_valid(solid.mesh, volume_));
    const std::size_t bad = test::count_bad(editor, criteria);
    const std::size_t refined = solid.mesh.tet_count();
    Surgery surgery(editor, criteria);
    Improver improver(surgery, criteria, context);
    const auto poor = [&] {
      std::size_t count = 0;
      for (TetId t = 0; t < solid.mesh.tet_slots(); ++t) {
        count += solid.mesh.alive(t) && surgery.shape(t) < 0.25 ? 1 : 0;
      }
      return count;
    };
    const std::size_t before = poor();
    ASSERT_TRUE(improver.mend(kGoal));
    ASSERT_TRUE(test::is_valid(solid.mesh, volume_));
    EXPECT_LE(test::count_bad(editor, criteria), bad);
    EXPECT_LE(poor(), before);
    ASSERT_TRUE(improver.round(kGoal));
    EXPECT_TRUE(test::is_valid(solid.mesh, volume_));
    EXPECT_LE(solid.mesh.tet_count(), refined);
    EXPECT_LE(20 * test::count_bad(editor, criteria), solid.mesh.tet_count());
  }

  InitialTetrahedralization solid_;
  MeshOptions options_;
  double volume_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Folds, SolidImproverFold, testing::Values(1, 2, 3, 6, 12, 64));

TEST_P(SolidImproverFold, BettersShapesWithFewerTetrahedra) {
  improve(solid_);
}

TEST_P(SolidImproverFold, SameBytesTwice) {
  InitialTetrahedralization other = solid_;
  improve(solid_);
  improve(other);
  EXPECT_EQ(test::fingerprint(solid_.mesh), test::fingerprint(other.mesh));
}

TEST_P(SolidImproverFold, LimitsEndInTheirCodes) {
  Editor editor(solid_.mesh);
  const Criteria criteria(solid_, options_);
  Surgery surgery(editor, criteria);
  ExecutionContext context;
  context.cancel();
  Improver improver(surgery, criteria, context);
  for (const auto& done : {improver.mend(kGoal), improver.coarsen(kGoal), improver.smooth_all(),
                           improver.round(kGoal)}) {
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::kCancelled);
  }
}

TEST_P(SolidImproverFold, VerticesOfTheCutGo) {
  if (GetParam() == 1) return;  // nothing is cut
  test::PrismSpec spec;
  spec.fold = GetParam();
  spec.corners = GetParam() < 3 ? 2 : 1;
  spec.inner_radius = 0.5;
  ExecutionContext context;
  auto solid = tetrahedralize_sector(test::prism_sector(spec), context);
  ASSERT_TRUE(solid) << solid.error().message;
  const double volume = test::quotient_volume(solid->mesh);
  Editor editor(solid->mesh);
  const Criteria criteria(*solid, {});
  Surgery surgery(editor, criteria);
  Improver improver(surgery, criteria, context);
  const auto on_input = [&] {
    std::size_t count = 0;
    for (std::size_t v = 0; v < solid->mesh.vertex_slots(); ++v) {
      const VertexKind kind = solid->mesh.kind(static_cast<VertexId>(v));
      count += kind == VertexKind::kSegment || kind == VertexKind::kFacet ? 1 : 0;
    }
    return count;
  };
  const std::size_t before = on_input();
  EXPECT_GT(before, 0U);
  const std::size_t left = improver.collapse_cut_vertices();
  EXPECT_LE(left, before);
  EXPECT_EQ(left, on_input());
  RecordProperty("left", static_cast<int>(left));
  EXPECT_TRUE(test::is_valid(solid->mesh, volume));
}

// What is stuck after mending gets better by detours, and nothing gets worse for it.
TEST_P(SolidImproverFold, DetoursBetterTheWorst) {
  constexpr double kWanted = 0.42;  // 25 degrees
  Editor editor(solid_.mesh);
  const Criteria criteria(solid_, options_);
  ExecutionContext context;
  ASSERT_TRUE(Refiner(editor, criteria, context).run());
  test::random_flips(solid_.mesh, 100, 3);
  test::jitter(solid_.mesh, 0.3, 4);
  Editor flipped(solid_.mesh);
  Surgery surgery(flipped, criteria);
  Improver improver(surgery, criteria, context);
  const auto worst = [&] {
    std::vector<double> shapes;
    for (TetId t = 0; t < solid_.mesh.tet_slots(); ++t) {
      if (solid_.mesh.alive(t)) shapes.push_back(surgery.shape(t));
    }
    std::sort(shapes.begin(), shapes.end());
    return shapes;
  };
  ASSERT_TRUE(improver.mend(kWanted));
  const auto stuck = worst();
  const std::size_t bad = test::count_bad(flipped, criteria);
  improver.allow_detours(kWanted);
  ASSERT_TRUE(improver.mend(kWanted, 3));
  EXPECT_TRUE(test::is_valid(solid_.mesh, volume_));
  EXPECT_LE(test::count_bad(flipped, criteria), bad);
  const auto better = worst();
  const auto poor = [&](const std::vector<double>& shapes) {
    return std::lower_bound(shapes.begin(), shapes.end(), kWanted) - shapes.begin();
  };
  EXPECT_LE(poor(better), poor(stuck));
  if (bad == 0) {
    EXPECT_GE(better.front(), stuck.front());
  }
  RecordProperty("stuck", static_cast<int>(poor(stuck)));
  RecordProperty("left", static_cast<int>(poor(better)));
}

}  // namespace
}  // namespace symcell::solid
