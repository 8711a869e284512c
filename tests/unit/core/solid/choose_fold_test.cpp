// The fold whose cell is the smallest, of those a solid has.
#include "core/solid/choose_fold.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/solid/initial/initial_tetrahedralization.hpp"
#include "core/solid/mesh_solid.hpp"
#include "tests/support/solid_sectors.hpp"

namespace symcell::solid {
namespace {

// A prism with a bore, of as many corners as its largest fold.
class RingSource final : public SectorSource {
 public:
  RingSource(std::int32_t corners, double bore, std::int32_t fold)
      : corners_(corners), bore_(bore) {
    symmetry_.fold = fold;
    symmetry_.diameter = 2.2;
    symmetry_.fold_detected = true;
  }
  [[nodiscard]] const Symmetry& symmetry() const override { return symmetry_; }
  [[nodiscard]] const std::vector<std::string>& repairs() const override { return repairs_; }
  [[nodiscard]] std::int32_t candidates() const override { return 1; }
  [[nodiscard]] Result<Sector> sector(std::int32_t, ExecutionContext&) const override {
    test::PrismSpec spec;
    spec.fold = symmetry_.fold;
    spec.corners = corners_ / symmetry_.fold;
    spec.inner_radius = bore_;
    spec.levels = {0, 0.5};
    return test::prism_sector(spec);
  }
  [[nodiscard]] Result<std::unique_ptr<SectorSource>> with_fold(std::int32_t fold,
                                                                ExecutionContext&) const override {
    if (fold == refused) return fail(ErrorCode::kNotSymmetric, "not this one");
    asked.push_back(fold);
    auto other = std::make_unique<RingSource>(corners_, bore_, fold);
    return other;
  }

  std::int32_t refused = 0;
  mutable std::vector<std::int32_t> asked;

 private:
  std::int32_t corners_;
  double bore_;
  Symmetry symmetry_;
  std::vector<std::string> repairs_;
};

std::uint64_t cell_size(const SectorSource& source, const MeshOptions& options = {}) {
  ExecutionContext context;
  const auto outcome = mesh_solid(source, options, context);
  EXPECT_TRUE(outcome) << outcome.error().message;
  return outcome ? outcome->statistics.cell.elements : 0;
}

TEST(ChooseFold, ACellOfAThickRingIsNotTheSmallestAtTheLargestFold) {
  for (const std::int32_t corners : {48, 90, 120, 200}) {
    const RingSource ring(corners, 0.8, corners);
    ExecutionContext context;
    const auto chosen = choose_fold(ring, {}, context);
    ASSERT_TRUE(chosen) << chosen.error().message;
    ASSERT_TRUE(chosen->source) << corners;
    const std::int32_t fold = chosen->source->symmetry().fold;
    EXPECT_EQ(corners % fold, 0);
    EXPECT_LT(fold, corners);
    std::map<std::int32_t, std::uint64_t> cells;
    std::uint64_t least = cell_size(ring);
    for (std::int32_t n = 1; n <= corners; ++n) {
      if (corners % n == 0) least = std::min(least, cell_size(RingSource(corners, 0.8, n)));
    }
    // A few tetrahedra more or less come of the cut.
    EXPECT_LE(cell_size(*chosen->source), least + least / 5 + 8) << corners << " at " << fold;
  }
}

TEST(ChooseFold, TheLargestFoldStaysWhereItsCellIsTheSmallest) {
  // Round the axis an n-th is three tetrahedra of every disc.
  const RingSource disc(24, 0, 24);
  ExecutionContext context;
  const auto chosen = choose_fold(disc, {}, context);
  ASSERT_TRUE(chosen) << chosen.error().message;
  EXPECT_FALSE(chosen->source);
  ASSERT_FALSE(chosen->candidates.empty());
  EXPECT_EQ(chosen->candidates.front().fold, 24);
  EXPECT_TRUE(chosen->candidates.front().meshed);
}

TEST(ChooseFold, CandidatesAreDivisorsInDescendingOrder) {
  const RingSource ring(90, 0.8, 90);
  ExecutionContext context;
  const auto chosen = choose_fold(ring, {}, context);
  ASSERT_TRUE(chosen) << chosen.error().message;
  std::int32_t last = 91;
  for (const FoldEstimate& c : chosen->candidates) {
    EXPECT_EQ(90 % c.fold, 0);
    EXPECT_LT(c.fold, last);
    EXPECT_GT(c.elements, 0);
    last = c.fold;
  }
  EXPECT_EQ(last, 1);
}

TEST(ChooseFold, AFoldThatIsGivenOrAskedForOrSmallIsKept) {
  MeshOptions given, largest;
  given.fold = 48;
  largest.largest_fold = true;
  ExecutionContext context;
  const RingSource ring(48, 0.8, 48), small(6, 0.8, 6);
  for (const auto& chosen : {choose_fold(ring, given, context), choose_fold(ring, largest, context),
                             choose_fold(small, {}, context)}) {
    ASSERT_TRUE(chosen);
    EXPECT_FALSE(chosen->source);
    EXPECT_TRUE(chosen->candidates.empty());
  }
  EXPECT_TRUE(ring.asked.empty());
}

TEST(ChooseFold, WhatFailsIsNoCandidate) {
  RingSource ring(48, 0.8, 48);
  ring.refused = 24;
  ExecutionContext context;
  const auto chosen = choose_fold(ring, {}, context);
  ASSERT_TRUE(chosen) << chosen.error().message;
  for (const FoldEstimate& c : chosen->candidates) EXPECT_NE(c.fold, 24);
}

TEST(ChooseFold, CancellingEndsIt) {
  const RingSource ring(48, 0.8, 48);
  ExecutionContext context;
  context.cancel();
  const auto chosen = choose_fold(ring, {}, context);
  ASSERT_FALSE(chosen);
  EXPECT_EQ(chosen.error().code, ErrorCode::kCancelled);
}

TEST(SectorLoad, IsExactAtItsOwnFoldAndGrowsBothWays) {
  const RingSource ring(60, 0.8, 60);
  ExecutionContext context;
  auto sector = ring.sector(0, context);
  ASSERT_TRUE(sector);
  const auto solid = tetrahedralize_sector(*sector, context);
  ASSERT_TRUE(solid) << solid.error().message;
  const SectorLoad load(solid->mesh);
  EXPECT_DOUBLE_EQ(load.estimate(60), load.count());
  EXPECT_GE(load.estimate(1), load.count());
  EXPECT_GE(load.estimate(6000), load.count());
}

}  // namespace
}  // namespace symcell::solid
