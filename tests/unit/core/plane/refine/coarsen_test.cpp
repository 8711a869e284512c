#include "core/plane/refine/coarsen.hpp"

#include "core/plane/refine/refiner.hpp"
#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

TEST(Coarsener, FewerTrianglesAndNoneBad) {
  std::size_t before = 0, after = 0;
  for (const std::int32_t fold : {1, 2, 5, 12, 36}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      test::QuotientSample sample = test::random_sample(seed, fold);
      QuotientTriangulation& mesh = sample.mesh();
      MeshOptions options;
      options.min_angle_deg = 25;
      Criteria criteria(mesh, sample.start.subdomains, options);
      Editor editor(mesh);
      ExecutionContext context;
      Refiner::Settings settings;
      settings.relocate = false;
      Refiner refiner(editor, criteria, settings, context);
      const auto refined = refiner.run();
      ASSERT_TRUE(refined) << refined.error().message;
      const double area = test::area(mesh);
      const std::size_t refined_count = mesh.triangle_count();

      Coarsener coarsener(editor, criteria, refiner.surgery(), context);
      ASSERT_TRUE(coarsener.run());
      EXPECT_LE(mesh.triangle_count(), refined_count);
      before += refined_count;
      after += mesh.triangle_count();
      for (const TriangleId t : test::live_triangles(mesh)) {
        EXPECT_FALSE(criteria.is_bad(mesh, t)) << "triangle " << t;
      }
      EXPECT_NEAR(test::area(mesh), area, 1e-9 * area);
      test::expect_delaunay(mesh);
    }
  }
  EXPECT_LT(after, before);
}

// A block with a spike whose two sides meet in a corner far below the bound: all that is in it is
// exempt. Flips between an exempt triangle and a good one must not leave one that is bad.
TEST(Coarsener, FlipsBesideExemptTrianglesLeaveNoneBad) {
  struct Spike {
    double min_angle_deg;
    Point2 right, tip, left, corner;
  };
  const Spike spikes[] = {
      {30, {0.660776306, 1.00000026}, {-1.465, 8.084}, {0.660775974, 1}, {-1.357, 3.284}},
      {33, {0.711598671, 1.000011053}, {3.234, 5.449}, {0.711583333, 1}, {-3.061, -1.468}},
      {33, {0.792030058, 0.999997353}, {2.235, 5.912}, {0.792026532, 1}, {-3.032, 1.668}},
      {20, {0.653503409, 0.999999468}, {1.172, 4.182}, {0.653501606, 1}, {-1.284, 3.147}},
      {33, {0.373807127, 0.999957939}, {-0.132, 7.951}, {0.373790911, 1}, {-2.761, 3.28}},
      {30, {0.530596519, 1.00000036}, {-2.123, 13.674}, {0.530596449, 1}, {-2.495, 0.653}},
  };
  for (const Spike& spike : spikes) {
    SectorBuilder builder(1);
    std::vector<SectorBuilder::Vertex> loop;
    for (const Point2 p :
         {Point2{0, 0}, Point2{1, 0}, spike.right, spike.tip, spike.left, spike.corner}) {
      loop.push_back(builder.add_vertex(p));
    }
    builder.add_closed(loop, 1);
    test::QuotientSample sample = test::triangulated(builder.pslg(), 1);
    MeshOptions options;
    options.min_angle_deg = spike.min_angle_deg;
    Criteria criteria(sample.mesh(), sample.start.subdomains, options);
    Editor editor(sample.mesh());
    ExecutionContext context;
    Refiner refiner(editor, criteria, {}, context);
    ASSERT_TRUE(refiner.run());
    sample.mesh().compact();
    Coarsener coarsener(editor, criteria, refiner.surgery(), context);
    ASSERT_TRUE(coarsener.run());
    EXPECT_GT(coarsener.counters().merged, 0u);
    for (const TriangleId t : test::live_triangles(sample.mesh())) {
      EXPECT_FALSE(criteria.is_bad(sample.mesh(), t)) << "tip at x " << spike.tip.x;
    }
    test::expect_delaunay(sample.mesh());
  }
}

TEST(Coarsener, StopsWhenCancelled) {
  test::QuotientSample sample = test::random_sample(1, 3);
  MeshOptions options;
  Criteria criteria(sample.mesh(), sample.start.subdomains, options);
  Editor editor(sample.mesh());
  ExecutionContext context;
  Refiner refiner(editor, criteria, {}, context);
  ASSERT_TRUE(refiner.run());
  context.cancel();
  Coarsener coarsener(editor, criteria, refiner.surgery(), context);
  const auto ok = coarsener.run();
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().code, ErrorCode::kCancelled);
  test::expect_delaunay(sample.mesh());
}

}  // namespace
}  // namespace symcell::plane
