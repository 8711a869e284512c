// Which of a source's sectors are tetrahedralized, and in which order.
#include "core/solid/initial/starts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/solid_sectors.hpp"

namespace symcell::solid {
namespace {

// Prisms cut at angles of their own, by which they are known again.
class ListedSectors final : public SectorSource {
 public:
  struct Entry {
    double cost = 0;
    std::int64_t narrow = 1;
    ErrorCode fails = ErrorCode::kInternal;
    bool cut = true;
    bool usable = true;
  };
  ListedSectors(std::vector<Entry> entries, std::size_t effort)
      : entries_(std::move(entries)), effort_(effort) {
    symmetry_.fold = 6;
  }

  [[nodiscard]] const Symmetry& symmetry() const override { return symmetry_; }
  [[nodiscard]] const std::vector<std::string>& repairs() const override { return repairs_; }
  [[nodiscard]] std::int32_t candidates() const override {
    return static_cast<std::int32_t>(entries_.size());
  }
  [[nodiscard]] std::size_t effort() const override { return effort_; }
  [[nodiscard]] Result<Sector> sector(std::int32_t index, ExecutionContext&) const override {
    asked.push_back(index);
    const Entry& entry = entries_[static_cast<std::size_t>(index)];
    if (!entry.cut) return fail(entry.fails, "this one cannot be cut");
    test::PrismSpec spec;
    spec.fold = 6;
    spec.start_angle = 0.01 * (index + 1);
    Sector sector = test::prism_sector(spec);
    sector.meshing_cost = entry.cost;
    sector.narrow_corners = entry.narrow;
    if (!entry.usable) sector.faces.pop_back();  // a hole
    return sector;
  }
  [[nodiscard]] Result<std::unique_ptr<SectorSource>> with_fold(std::int32_t,
                                                                ExecutionContext&) const override {
    return fail(ErrorCode::kBadFold, "there is but one fold");
  }

  [[nodiscard]] std::int32_t preferred() const override {
    return preferred_.value_or(candidates());
  }
  void prefer(std::int32_t count) { preferred_ = count; }

  mutable std::vector<std::int32_t> asked;

 private:
  std::vector<Entry> entries_;
  std::size_t effort_;
  std::optional<std::int32_t> preferred_;
  Symmetry symmetry_;
  std::vector<std::string> repairs_;
};

// The candidate that a tetrahedralization comes from: its cut's vertices lie at the start angle.
std::int32_t origin(const InitialTetrahedralization& solid) {
  for (std::int32_t i = 0; i < 20; ++i) {
    const double angle = 0.01 * (i + 1);
    for (std::size_t v = 0; v < solid.mesh.vertex_slots(); ++v) {
      const Point3 p = solid.mesh.point(static_cast<VertexId>(v));
      const double radius = std::hypot(p.x, p.y);
      if (radius > 0.1 && std::abs(std::atan2(p.y, p.x) - angle) < 1e-9) return i;
    }
  }
  return -1;
}

TEST(SolidStarts, FacetsAsGivenAreTakenInOrder) {
  const ListedSectors source({{3, 1}, {1, 1}, {2, 1}}, 0);
  Starts starts(source);
  ExecutionContext context;
  for (std::int32_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(starts.has_next());
    const auto solid = starts.next(context);
    ASSERT_TRUE(solid) << solid.error().message;
    EXPECT_EQ(origin(*solid), i);
  }
  EXPECT_FALSE(starts.has_next());
  EXPECT_EQ(starts.next(context).error().code, ErrorCode::kTetrahedralizationFailed);
}

TEST(SolidStarts, TheCheapestOfThoseComparedComesFirst) {
  const ListedSectors source({{30, 4}, {10, 1}, {20, 2}}, 100);
  Starts starts(source);
  ExecutionContext context;
  for (const std::int32_t expected : {1, 2}) {
    const auto solid = starts.next(context);
    ASSERT_TRUE(solid) << solid.error().message;
    EXPECT_EQ(origin(*solid), expected);
  }
  // The dearest promises more than 2.5 times what the cheapest did.
  EXPECT_FALSE(starts.next(context));
  EXPECT_EQ(starts.effort(), 300U);
}

TEST(SolidStarts, ComparingEndsWhereNoCornerIsNarrowAfterSomeEffort) {
  for (const std::size_t effort : {100, 6'000}) {
    const ListedSectors source({{30, 4}, {40, 0}, {20, 2}}, effort);
    Starts starts(source);
    ExecutionContext context;
    const auto solid = starts.next(context);
    ASSERT_TRUE(solid) << solid.error().message;
    const bool all = effort < 1'000;
    EXPECT_EQ(source.asked.size(), all ? 3U : 2U);
    EXPECT_EQ(origin(*solid), all ? 2 : 0);
  }
}

TEST(SolidStarts, ComparingEndsWhereCutsMakeNoDifference) {
  const ListedSectors source({{20, 0}, {20, 0}, {10, 0}}, 100);
  Starts starts(source);
  ExecutionContext context;
  const auto solid = starts.next(context);
  ASSERT_TRUE(solid) << solid.error().message;
  EXPECT_EQ(source.asked.size(), 2U);
  EXPECT_EQ(origin(*solid), 0);
}

TEST(SolidStarts, TheEarlierOfMuchTheSameComesFirst) {
  const ListedSectors source({{20, 1}, {19.5, 1}, {30, 1}}, 100);
  Starts starts(source);
  ExecutionContext context;
  for (const std::int32_t expected : {0, 1, 2}) {
    const auto solid = starts.next(context);
    ASSERT_TRUE(solid) << solid.error().message;
    EXPECT_EQ(origin(*solid), expected);
  }
}

TEST(SolidStarts, OthersAreForWhereThePreferredFail) {
  for (const bool fails : {false, true}) {
    ListedSectors::Entry first{30, 4}, second{20, 4}, other{10, 4};
    first.cut = second.cut = !fails;
    ListedSectors source({first, second, other}, 100);
    source.prefer(2);
    Starts starts(source);
    ExecutionContext context;
    const auto solid = starts.next(context);
    ASSERT_TRUE(solid) << solid.error().message;
    EXPECT_EQ(origin(*solid), fails ? 2 : 1);
    EXPECT_EQ(source.asked.size(), fails ? 3U : 2U);
  }
}

// Of the first ones that cannot be cut: as many others are looked at.
TEST(SolidStarts, SectorsAreComparedNotAttempts) {
  ListedSectors::Entry uncut;
  uncut.cut = false;
  std::vector<ListedSectors::Entry> entries(10, uncut);
  entries.push_back({30, 4});
  entries.push_back({10, 1});
  const ListedSectors source(entries, 100);
  Starts starts(source);
  ExecutionContext context;
  const auto solid = starts.next(context);
  ASSERT_TRUE(solid) << solid.error().message;
  EXPECT_EQ(origin(*solid), 11);
}

TEST(SolidStarts, LargeSurfacesAreNotCompared) {
  const ListedSectors source({{30, 4}, {10, 1}}, 1'000'000);
  Starts starts(source);
  ExecutionContext context;
  const auto solid = starts.next(context);
  ASSERT_TRUE(solid) << solid.error().message;
  EXPECT_EQ(source.asked.size(), 1U);
}

TEST(SolidStarts, WhatCannotBeCutOrTetrahedralizedIsPassedOver) {
  ListedSectors::Entry uncut, open, good;
  uncut.cut = false;
  open.usable = false;
  const ListedSectors source({uncut, open, good}, 0);
  Starts starts(source);
  ExecutionContext context;
  const auto solid = starts.next(context);
  ASSERT_TRUE(solid) << solid.error().message;
  EXPECT_EQ(origin(*solid), 2);
}

TEST(SolidStarts, LimitsEndTheSearch) {
  ListedSectors::Entry late, good;
  late.cut = false;
  late.fails = ErrorCode::kTimeLimit;
  const ListedSectors source({late, good}, 0);
  Starts starts(source);
  ExecutionContext context;
  EXPECT_EQ(starts.next(context).error().code, ErrorCode::kTimeLimit);
  EXPECT_EQ(source.asked.size(), 1U);
}

}  // namespace
}  // namespace symcell::solid
