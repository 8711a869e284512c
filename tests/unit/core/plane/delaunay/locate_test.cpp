#include "core/plane/delaunay/locate.hpp"

#include "core/plane/delaunay/insert.hpp"
#include "core/plane/quotient/lifted_predicates.hpp"
#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

using test::Dice;
using test::QuotientSample;

void insert_points(QuotientTriangulation& mesh, Dice& dice, int count) {
  Editor editor(mesh);
  Cavity cavity;
  for (int i = 0; i < count; ++i) {
    const TriangleId t = dice.triangle(mesh);
    const Point2 x = dice.point_in(mesh, t);
    editor.compute_cavity(t, x, cavity);
    static_cast<void>(editor.insert_in_cavity(t, x, cavity, VertexKind::kFree));
  }
}

// In a convex domain without inner segments nothing can block a walk.
TEST(Locate, FindsTheTriangleInEverySector) {
  for (const std::int32_t fold : {3, 4, 7, 12, 31}) {
    Dice dice(static_cast<std::uint64_t>(fold));
    QuotientSample sample = test::wheel(fold, false);
    const QuotientTriangulation& mesh = sample.mesh();
    insert_points(sample.mesh(), dice, 60);
    for (int i = 0; i < 300; ++i) {
      const TriangleId target = dice.triangle(mesh), start = dice.triangle(mesh);
      const auto e = static_cast<std::int32_t>(dice.below(static_cast<std::size_t>(fold)));
      const Point2 x = mesh.rotations().rotate(dice.point_in(mesh, target), e);
      const Location found = locate(mesh, start, x);
      ASSERT_EQ(found.kind, Location::Kind::kInside);
      EXPECT_EQ(triangle_of(found.half_edge), target);
      EXPECT_EQ(found.exponent, e);
    }
  }
}

TEST(Locate, WhatItFindsHoldsThePointOrBlocksTheWay) {
  for (const std::int32_t fold : {1, 2, 5, 9}) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      Dice dice(seed);
      QuotientSample sample = test::random_sample(seed, fold);
      const QuotientTriangulation& mesh = sample.mesh();
      insert_points(sample.mesh(), dice, 20);
      int inside = 0;
      for (int i = 0; i < 100; ++i) {
        const TriangleId start = dice.triangle(mesh);
        const Point2 x = mesh.rotations().rotate(
            dice.point_in(mesh, dice.triangle(mesh)),
            static_cast<std::int32_t>(dice.below(static_cast<std::size_t>(fold))));
        const Location found = locate(mesh, start, x);
        ASSERT_NE(found.kind, Location::Kind::kLost);
        const Triangle& t = mesh.triangle(triangle_of(found.half_edge));
        if (found.kind == Location::Kind::kBlocked) {
          EXPECT_NE(t.seg[local_of(found.half_edge)], kNoSubsegment);
          continue;
        }
        ++inside;
        const Point2 y = mesh.rotations().rotate(x, mesh.subtract(0, found.exponent));
        for (std::uint32_t j = 0; j < 3; ++j) {
          const Point2 a = mesh.corner_point(t, next3(j)), b = mesh.corner_point(t, prev3(j));
          EXPECT_GE(cross(b - a, y - a), -1e-12 * squared_distance(a, b));
        }
      }
      EXPECT_GT(inside, 0);
    }
  }
}

}  // namespace
}  // namespace symcell::plane
