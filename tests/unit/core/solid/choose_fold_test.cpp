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

#include "core/mesh_model.hpp"
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

// A ring of that many sides, as a tessellation.
TriangleSurface ring_surface(std::int32_t sides, double outer, double inner, double height) {
  TriangleSurface tube;
  for (const double r : {outer, inner}) {
    for (const double z : {0.0, height}) {
      for (std::int32_t i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        tube.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
      }
    }
  }
  const auto quad = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    tube.triangles.push_back({a, b, c});
    tube.triangles.push_back({a, c, d});
  };
  for (std::int32_t i = 0; i < sides; ++i) {
    const std::int32_t j = (i + 1) % sides, n = sides;
    quad(i, j, n + j, n + i);                          // outside
    quad(2 * n + j, 2 * n + i, 3 * n + i, 3 * n + j);  // bore
    quad(n + i, n + j, 3 * n + j, 3 * n + i);          // top
    quad(j, i, 2 * n + i, 2 * n + j);                  // bottom
  }
  return tube;
}

// Long thin triangles of a thin ring: two thirds of such cells were over the ratio.
TEST(MeshModel, AThinRingOfManySidesKeepsItsBounds) {
  const TriangleSurface ring = ring_surface(120, 10, 9.7, 6);
  for (const std::int32_t fold : {1, 4}) {
    ExecutionContext context;
    MeshOptions options;
    options.fold = fold;
    const auto outcome = mesh_model(ring, options, context);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_TRUE(outcome->statistics.exempt.empty()) << fold;
    EXPECT_GT(outcome->statistics.cell.min_dihedral_deg, 15) << fold;
  }
}

// All the way, from a surface.
TEST(ChooseFold, StatisticsOfATubeListTheFolds) {
  constexpr std::int32_t kSides = 120;
  const TriangleSurface tube = ring_surface(kSides, 10, 8, 6);
  ExecutionContext context;
  MeshOptions options;
  const auto chosen = mesh_model(tube, options, context);
  ASSERT_TRUE(chosen) << chosen.error().message;
  options.largest_fold = true;
  const auto largest = mesh_model(tube, options, context);
  ASSERT_TRUE(largest) << largest.error().message;
  EXPECT_EQ(largest->statistics.symmetry.fold, kSides);
  EXPECT_TRUE(largest->statistics.symmetry.candidates.empty());
  EXPECT_LT(chosen->statistics.symmetry.fold, kSides);
  EXPECT_TRUE(chosen->statistics.symmetry.detected);
  EXPECT_LT(chosen->statistics.cell.elements, largest->statistics.cell.elements);
  ASSERT_FALSE(chosen->statistics.symmetry.candidates.empty());
  EXPECT_EQ(chosen->statistics.symmetry.candidates.front().fold, kSides);
}

}  // namespace
}  // namespace symcell::solid
