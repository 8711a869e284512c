// What the tests of editable surfaces share: surfaces to edit, and checks that neighbours, stars and
// marks are still those of the triangles.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "core/solid/surface/editable_surface.hpp"
#include "tests/unit/core/solid/surface_checks.hpp"

namespace symcell::solid::test {

inline std::int32_t slots(const EditableSurface& mesh) {
  return static_cast<std::int32_t>(mesh.surface().triangles.size());
}

inline int live(const EditableSurface& mesh) {
  int count = 0;
  for (std::int32_t t = 0; t < slots(mesh); ++t) count += mesh.alive(t) ? 1 : 0;
  return count;
}

inline QuotientSurface sample(std::int32_t fold, double bore = 0.5) {
  PrismShape shape;
  shape.fold = fold;
  shape.bore = bore;
  return one_sector(asymmetric_prism(shape, 8), fold, 0.3);
}

// Whole, cut, and cut with the axis inside.
inline std::vector<QuotientSurface> samples() {
  return {uncut(sphere(2)),
          uncut(divided(box_surface({0, 0, 0}, {1, 1, 1}))),
          sample(2),
          sample(5),
          sample(2, 0),
          sample(5, 0),
          one_sector(sphere(3), 4, 0.3)};
}

// Stars, neighbours and marks agree with the triangles.
inline void expect_consistent(const EditableSurface& mesh) {
  std::vector<std::set<std::int32_t>> stars(mesh.surface().points.size());
  for (std::int32_t t = 0; t < slots(mesh); ++t) {
    if (!mesh.alive(t)) continue;
    for (std::int32_t side = 0; side < 3; ++side) {
      stars[mesh.surface().triangles[t][side].orbit].insert(t);
      const QuotientNeighbour n = mesh.across(t, side);
      ASSERT_GE(n.triangle, 0);
      ASSERT_TRUE(mesh.alive(n.triangle));
      const QuotientNeighbour back = mesh.across(n.triangle, n.side);
      EXPECT_EQ(back.triangle, t);
      EXPECT_EQ(back.side, side);
      EXPECT_EQ(back.exponent, -n.exponent);
      EXPECT_EQ(mesh.mark(t, side), mesh.mark(n.triangle, n.side));
      EXPECT_EQ((mesh.mark(t, side) & kCutSide) != 0, n.exponent != 0);
      // Turned by the exponent the neighbour's side is this one, run through the other way.
      const RotationTable rotations(mesh.surface().fold);
      const std::int32_t turn = rotations.reduce(n.exponent);
      const auto here = mesh.points(t), there = mesh.points(n.triangle);
      EXPECT_LT(distance(rotations.rotate(there[n.side], turn), here[(side + 1) % 3]), 1e-13);
      EXPECT_LT(distance(rotations.rotate(there[(n.side + 1) % 3], turn), here[side]), 1e-13);
    }
  }
  for (std::size_t v = 0; v < stars.size(); ++v) {
    const auto& star = mesh.star(static_cast<std::int32_t>(v));
    EXPECT_EQ(std::set<std::int32_t>(star.begin(), star.end()), stars[v]);
    EXPECT_EQ(star.size(), stars[v].size());
  }
}

inline void expect_as_planned(const EditableSurface& mesh,
                              std::span<const PlannedTriangle> planned) {
  for (const PlannedTriangle& p : planned) {
    ASSERT_TRUE(mesh.alive(p.id));
    EXPECT_EQ(mesh.surface().triangles[p.id], p.corners);
    EXPECT_EQ(mesh.points(p.id), p.points);
  }
}

}  // namespace symcell::solid::test
