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
