// Symmetrisation of models made for one question each.
#include "core/plane/symmetry/symmetrise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/plane/input/validate_pslg.hpp"
#include "core/plane/symmetry/lifted_check.hpp"
#include "tests/support/pslg_builders.hpp"
#include "tests/support/symmetry_checks.hpp"

namespace symcell::plane {
namespace {

Result<SymmetricPslg> run(const Pslg& pslg, const MeshOptions& options = {}) {
  ExecutionContext context;
  const auto valid = validate_pslg(pslg, context);
  EXPECT_TRUE(valid) << valid.error().message;
  return symmetrise(pslg, options, context);
}

void expect_fold(const Pslg& pslg, std::int32_t fold, const MeshOptions& options = {}) {
  const auto found = run(pslg, options);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->fold, fold);
  EXPECT_TRUE(found->fold_detected);
  expect_symmetric_invariants(*found, pslg);
}

Pslg jittered(Pslg pslg, double amount, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  for (Point2& p : pslg.vertices) p = {p.x + uniform(engine), p.y + uniform(engine)};
  return pslg;
}

TEST(Symmetrise, FindsTheFoldOfPlainModels) {
  for (const std::int32_t n : {3, 4, 5, 6, 7, 16, 17, 72, 100, 360}) {
    SCOPED_TRACE(n);
    expect_fold(regular_ring(n, 2, 1), n);
    expect_fold(transformed(regular_ring(n, 2, 0), 1e4, 0.3, {1e4, -7e4}), n);
    expect_fold(transformed(gear(n, 2, 1.6, 0.4), 1e-4, 1.1, {0.3, 0.2}), n);
    expect_fold(spoked_wheel(n, 3), n);
  }
  expect_fold(flange(8, 10, 7, 1, 3), 8);
  expect_fold(star(5, 10, 3), 5);
}

TEST(Symmetrise, FinePolygonsKeepTheirOwnFold) {
  // Every fold fits these within the default tolerance.
  for (const std::int32_t n : {2000, 5000}) expect_fold(regular_ring(n, 1, 0), n);
  // A fine ring with six notches is a six-fold part, whatever the fineness of the ring.
  SectorBuilder builder(6);
  std::vector<SectorBuilder::Vertex> rim;
  for (int i = 0; i < 400; ++i) {
    const double angle = std::numbers::pi / 3 * i / 400;
    const double radius = i < 3 ? 0.99 : 1.0;
    rim.push_back(builder.add_vertex({radius * std::cos(angle), radius * std::sin(angle)}));
  }
  builder.add_loop(rim, 1);
  expect_fold(builder.pslg(), 6);
}

TEST(Symmetrise, NoiseIsAveragedAndReported) {
  for (const double noise : {1e-13, 1e-10, 1e-8, 2e-7}) {
    for (const std::int32_t n : {2, 5, 12, 36}) {
      SCOPED_TRACE(std::to_string(n) + " " + std::to_string(noise));
      const Pslg exact = n == 2 ? random_symmetric_pslg(3, 2, nullptr) : gear(n, 2, 1.6, 0.4);
      ExecutionContext context;
      const auto size = inspect_pslg(exact, {}, context);
      ASSERT_TRUE(size);
      const Pslg noisy = jittered(exact, noise * size->diameter, 5);
      const auto found = run(noisy);
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_EQ(found->fold, n);
      EXPECT_LE(found->symmetry_error_rel, 2 * noise);
      EXPECT_GE(found->symmetry_error_rel, 0.1 * noise);
      expect_symmetric_invariants(*found, noisy);
    }
  }
  const auto beyond = run(jittered(gear(12, 2, 1.6, 0.4), 1e-4, 5));
  ASSERT_TRUE(beyond);
  EXPECT_EQ(beyond->fold, 1);
}

// The shape has the copies of a vertex that is a little off; the vertices have them a little beside.
TEST(Symmetrise, OneVertexOffWithinTheToleranceGetsNoCopiesBesideOthers) {
  for (const double off : {1e-9, 4e-8, 1e-6, 5e-6}) {
    for (const Point2 way : {Point2{1, 0}, Point2{0, 1}, Point2{-0.6, 0.8}}) {
      SCOPED_TRACE(off);
      Pslg pslg = regular_ring(12, 10, 4);
      pslg.vertices[11] = pslg.vertices[11] + off * way;
      const auto found = run(pslg);
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_EQ(found->fold, 12);
      EXPECT_EQ(found->orbit_points.size() * 12, pslg.vertices.size());
      EXPECT_LE(found->symmetry_error_rel, 1e-6);
    }
  }
}

TEST(Symmetrise, OneVertexOffByMoreThanTheToleranceForbidsTheFold) {
  Pslg pslg = regular_ring(12, 10, 4);
  pslg.vertices[11] = pslg.vertices[11] + Point2{0, 3.4e-5};  // 1.2e-6 of the diameter
  const auto found = run(pslg);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->orbit_points.size() * static_cast<std::size_t>(found->fold),
            pslg.vertices.size());
  MeshOptions wider;
  wider.symmetry_tolerance_rel = 1e-5;
  EXPECT_EQ(run(pslg, wider)->fold, 12);
}

// Along a side of many the shape hardly changes.
TEST(Symmetrise, OneVertexOffByANearMissForbidsTheFold) {
  for (const double off : {3.4e-5, 1e-4, 2.5e-4}) {  // up to 0.9e-5 of the diameter
    SCOPED_TRACE(off);
    Pslg pslg = regular_ring(96, 10, 4);
    const Point2 side = pslg.vertices[12] - pslg.vertices[11];
    pslg.vertices[11] = pslg.vertices[11] + (off / length(side)) * side;
    const auto found = run(pslg);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->orbit_points.size() * static_cast<std::size_t>(found->fold),
              pslg.vertices.size());
  }
}

TEST(Symmetrise, CoordinatesRoundedToSixDigitsPass) {
  Pslg pslg = gear(24, 2, 1.6, 0.4);
  for (Point2& p : pslg.vertices) p = {std::round(p.x * 1e6) / 1e6, std::round(p.y * 1e6) / 1e6};
  expect_fold(pslg, 24);
}

TEST(Symmetrise, MarkersAndRegionsCountUnlessIgnored) {
  Pslg pslg = gear(12, 2, 1.6, 0.4);
  for (std::int32_t k = 0; k < 12; ++k) pslg.segments[static_cast<std::size_t>(k)].marker = k % 4;
  MeshOptions options;
  expect_fold(pslg, 3, options);
  options.ignore_markers = true;
  expect_fold(pslg, 12, options);
  const auto found = run(pslg, options);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->uniform_markers);

  Pslg wheel = spoked_wheel(6, 2);
  for (std::size_t k = 0; k < 6; k += 2) wheel.regions[k].max_area = 0.5;
  options.ignore_markers = false;
  expect_fold(wheel, 3, options);
  options.ignore_markers = true;
  expect_fold(wheel, 6, options);
}

TEST(Symmetrise, CopiesKeepTheirMarkersWhenIgnored) {
  Pslg pslg = regular_ring(5, 2, 0);
  for (std::int32_t k = 0; k < 5; ++k) pslg.segments[static_cast<std::size_t>(k)].marker = 10 + k;
  MeshOptions options;
  options.ignore_markers = true;
  const auto found = run(pslg, options);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->fold, 5);
  const Pslg lifted = lift_pslg(*found);
  for (const PslgSegment& s : lifted.segments) {
    const Point2 middle = 0.5 * (lifted.vertices[static_cast<std::size_t>(s.a)] +
                                 lifted.vertices[static_cast<std::size_t>(s.b)]);
    for (const PslgSegment& t : pslg.segments) {
      const Point2 other = 0.5 * (pslg.vertices[static_cast<std::size_t>(t.a)] +
                                  pslg.vertices[static_cast<std::size_t>(t.b)]);
      if (distance(middle + found->centre, other) < 1e-9) {
        EXPECT_EQ(s.marker, t.marker);
      }
    }
  }
}

TEST(Symmetrise, HolesCountEvenIfMarkersAreIgnored) {
  Pslg pslg = flange(8, 10, 7, 1, 3);
  // Only every other bolt hole is a hole; seed 8 is the bore's.
  pslg.holes = {pslg.holes[0], pslg.holes[2], pslg.holes[4], pslg.holes[6], pslg.holes[8]};
  MeshOptions options;
  options.ignore_markers = true;
  expect_fold(pslg, 4, options);
}

TEST(Symmetrise, SegmentThroughTheCentreIsCutThere) {
  SectorBuilder builder(2);
  const auto a = builder.add_vertex({2, 0});
  builder.add_loop({a, builder.add_vertex({0.5, 1})}, 1);
  builder.add_diameter(a, 4);
  const auto found = run(builder.pslg());
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->fold, 2);
  ASSERT_GE(found->centre_orbit, 0);
  expect_symmetric_invariants(*found, builder.pslg());
}

TEST(Symmetrise, StrayPartsTakeNoPart) {
  Pslg pslg = gear(7, 2, 1.6, 0.4);
  const auto first = static_cast<std::int32_t>(pslg.vertices.size());
  // A loose segment in the bore, one outside, a vertex in each.
  for (const Point2 p : {Point2{0, 0.05}, {0.1, 0.1}, {5, 5}, {6, 5}, {-0.1, 0}, {-4, 3}}) {
    pslg.vertices.push_back(p);
  }
  pslg.segments.push_back({first, first + 1, 9});
  pslg.segments.push_back({first + 2, first + 3, 9});
  expect_fold(pslg, 7);
}

TEST(Symmetrise, RepeatedSegmentsCountOnce) {
  Pslg pslg = regular_ring(6, 2, 1);
  const PslgSegment third = pslg.segments[3];
  pslg.segments.push_back({third.b, third.a, third.marker});
  expect_fold(pslg, 6);
}

TEST(Symmetrise, TouchingVerticesOffByRoundingAreTaken) {
  // Spokes whose outer ends lie in the interior of the rim's segments, by construction only nearly.
  SectorBuilder builder(7);
  const auto rim = builder.add_vertex({2, 0});
  builder.add_loop({rim}, 1);
  const Point2 next = builder.turned({2, 0}, 1);
  const auto touch = builder.add_vertex(Point2{2, 0} + 0.37 * (next - Point2{2, 0}));
  builder.add_segment(touch, builder.add_vertex({0.7, 0.2}), 2);
  for (int i = 0; i < 20; ++i) {
    expect_fold(transformed(builder.pslg(), 1, 0.1 * i, {0.3 * i, -0.7 * i}), 7);
  }
}

TEST(Symmetrise, DeclaredCentreMustFit) {
  const Pslg pslg = transformed(gear(9, 2, 1.6, 0.4), 1, 0, {3, 4});
  MeshOptions options;
  options.fold = 9;
  options.center = Point2{3.001, 4};
  const auto wrong = run(pslg, options);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, ErrorCode::kNotSymmetric);
  options.center = Point2{3, 4};
  const auto right = run(pslg, options);
  ASSERT_TRUE(right) << right.error().message;
  EXPECT_FALSE(right->centre_detected);
  EXPECT_FALSE(right->fold_detected);
  options.fold.reset();
  options.center = Point2{3.5, 4};
  const auto none = run(pslg, options);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->fold, 1);
}

TEST(Symmetrise, BadOptionsAreRefused) {
  MeshOptions options;
  for (const std::int32_t fold : {0, -3, 2'000'000'000}) {
    options.fold = fold;
    const auto result = run(regular_ring(6, 2, 1), options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::kBadFold);
  }
  options.fold = 6;
  options.center = Point2{std::nan(""), 0};
  const auto result = run(regular_ring(6, 2, 1), options);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kBadAxis);
}

TEST(Symmetrise, SameInputGivesTheSameResult) {
  const Pslg pslg = random_symmetric_pslg(11, 9, nullptr);
  const auto first = run(pslg);
  const auto second = run(pslg);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->orbit_points, second->orbit_points);
  EXPECT_EQ(first->centre, second->centre);
  EXPECT_EQ(first->holes, second->holes);
}

TEST(Symmetrise, CancelIsHeeded) {
  ExecutionContext context;
  context.cancel();
  const auto result = symmetrise(regular_ring(6, 2, 1), {}, context);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kCancelled);
}

// A gear of 12 waves that 221 points sample: all sectors differ, and none stands for the others within a
// tolerance little above the sagitta. Each then gets the vertices of all, which is told.
TEST(Symmetrise, TellsWhereSectorsGotTheVerticesOfAll) {
  constexpr int kPoints = 221;
  Pslg pslg;
  for (int i = 0; i < kPoints; ++i) {
    const double t = 4.9020231593 + 2 * std::numbers::pi * i / kPoints;
    const double r = 1 + 0.0610624188 * std::sin(12 * t + 1) + 0.0183187256 * std::sin(24 * t + 1);
    pslg.vertices.push_back({r * std::cos(t), r * std::sin(t)});
    pslg.segments.push_back({i, (i + 1) % kPoints, 0});
  }
  MeshOptions options;
  options.symmetry_tolerance_rel = 0.00111;
  const auto tells = [](const SymmetricPslg& found) {
    return std::any_of(found.warnings.begin(), found.warnings.end(),
                       [](const Warning& w) { return w.code == WarningCode::kVerticesCopied; });
  };
  const auto found = run(pslg, options);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->fold, 12);
  EXPECT_GT(found->copied_vertices, 0U);
  EXPECT_TRUE(tells(*found));
  options.keep_vertices = true;
  const auto asked_for = run(pslg, options);
  ASSERT_TRUE(asked_for) << asked_for.error().message;
  EXPECT_FALSE(tells(*asked_for));
  options = {};
  options.symmetry_tolerance_rel = 0.003;
  EXPECT_FALSE(tells(*run(pslg, options)));
}

}  // namespace
}  // namespace symcell::plane
