// Rounds of improvement: shapes get better, bounds stay, nothing breaks.
#include "core/improve/solid_improver.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/refine/solid_refiner.hpp"
#include "tests/support/solid_sectors.hpp"
#include "tests/unit/core/solid_checks.hpp"

namespace symcell {
namespace {

constexpr double kGoal = 0.5;  // sine of 30 degrees

class SolidImproverFold : public testing::TestWithParam<std::int32_t> {
 protected:
  SolidImproverFold() : solid_(test::prism(test::prism_shape(GetParam()))) {
    volume_ = test::quotient_volume(solid_.mesh);
    options_.max_volume = volume_ / 250;
  }

  void improve(InitialTetrahedralization& solid) {
    SolidEditor editor(solid.mesh);
    const SolidCriteria criteria(solid, options_);
    ExecutionContext context;
    ASSERT_TRUE(SolidRefiner(editor, criteria, context).run());
    ASSERT_TRUE(test::is_valid(solid.mesh, volume_));
    const std::size_t bad = test::count_bad(editor, criteria);
    const std::size_t refined = solid.mesh.tet_count();
    SolidSurgery surgery(editor, criteria);
    SolidImprover improver(surgery, criteria, context);
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
  SolidEditor editor(solid_.mesh);
  const SolidCriteria criteria(solid_, options_);
  SolidSurgery surgery(editor, criteria);
  ExecutionContext context;
  context.cancel();
  SolidImprover improver(surgery, criteria, context);
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
  SolidEditor editor(solid->mesh);
  const SolidCriteria criteria(*solid, {});
  SolidSurgery surgery(editor, criteria);
  SolidImprover improver(surgery, criteria, context);
  const auto on_input = [&] {
    std::size_t count = 0;
    for (std::size_t v = 0; v < solid->mesh.vertex_slots(); ++v) {
      const SolidVertexKind kind = solid->mesh.kind(static_cast<VertexId>(v));
      count += kind == SolidVertexKind::kSegment || kind == SolidVertexKind::kFacet ? 1 : 0;
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
  SolidEditor editor(solid_.mesh);
  const SolidCriteria criteria(solid_, options_);
  ExecutionContext context;
  ASSERT_TRUE(SolidRefiner(editor, criteria, context).run());
  test::random_flips(solid_.mesh, 100, 3);
  test::jitter(solid_.mesh, 0.3, 4);
  SolidEditor flipped(solid_.mesh);
  SolidSurgery surgery(flipped, criteria);
  SolidImprover improver(surgery, criteria, context);
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
}  // namespace symcell
