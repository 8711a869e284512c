// What a planar mesh covers: the same after refinement, changed by any damage.
#include "core/plane/quotient/segment_cover.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/plane/delaunay/insert.hpp"
#include "core/plane/refine/criteria.hpp"
#include "core/plane/refine/refiner.hpp"
#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

std::string fault(const SegmentCover& wanted, const SegmentCover& found) {
  const auto ok = compare_segment_covers(wanted, found);
  return ok ? "" : ok.error().message;
}

Pslg two_rooms() {
  SectorBuilder builder(1);
  const auto a = builder.add_vertex({0, 0}), b = builder.add_vertex({2, 0}),
             c = builder.add_vertex({4, 0}), d = builder.add_vertex({4, 2}),
             e = builder.add_vertex({2, 2}), f = builder.add_vertex({0, 2}),
             g = builder.add_vertex({1, 1}), h = builder.add_vertex({1.5, 1.2});
  builder.add_closed({a, b, c, d, e, f}, 1);
  builder.add_segment(b, e, 2);
  builder.add_segment(g, h, 3);  // dangles
  return builder.pslg();
}

std::vector<test::QuotientSample> samples() {
  std::vector<test::QuotientSample> all;
  all.push_back(test::triangulated(two_rooms(), 1));
  for (const std::int32_t fold : {1, 2, 3, 6}) {
    all.push_back(test::triangulated(star(6, 2, 0.8), fold));
    all.push_back(test::triangulated(regular_ring(6, 2, 1), fold));
    all.push_back(test::triangulated(spoked_wheel(6, 2), fold));
  }
  all.push_back(test::pads(5));
  all.push_back(test::triangulated(flange(4, 4, 3, 0.5, 1), 4));
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    all.push_back(test::random_sample(seed, 1 + static_cast<std::int32_t>(seed % 7)));
  }
  return all;
}

TEST(SegmentCover, TellsLengthsAreaAndEulerCharacteristic) {
  const auto rooms = test::triangulated(two_rooms(), 1);
  const SegmentCover cover = measure_segment_cover(rooms.start.mesh);
  double one = 0, two = 0;
  for (const auto& s : cover.segments) {
    one += s.one_sided;
    two += s.two_sided;
  }
  EXPECT_NEAR(one, 12, 1e-12);
  EXPECT_NEAR(two, 2 + std::hypot(0.5, 0.2), 1e-12);
  EXPECT_NEAR(cover.area, 8, 1e-12);
  EXPECT_EQ(cover.euler, 1);
  EXPECT_EQ(measure_segment_cover(test::triangulated(regular_ring(6, 2, 1), 6).start.mesh).euler,
            0);
  EXPECT_EQ(measure_segment_cover(test::triangulated(star(6, 2, 1), 6).start.mesh).euler, 1);
  EXPECT_EQ(measure_segment_cover(test::pads(5).start.mesh).euler, 5);
  const auto bolted = test::triangulated(flange(4, 4, 3, 0.5, 1), 4);
  EXPECT_EQ(measure_segment_cover(bolted.start.mesh).euler, 1 - 5);
}

TEST(SegmentCover, RefinementChangesNothing) {
  for (test::QuotientSample& sample : samples()) {
    const SegmentCover wanted = measure_segment_cover(sample.mesh());
    EXPECT_EQ(fault(wanted, wanted), "");
    MeshOptions options;
    options.min_angle_deg = 25;
    Criteria criteria(sample.mesh(), sample.start.subdomains, options);
    Editor editor(sample.mesh());
    ExecutionContext context;
    context.set_max_elements(20'000);
    Refiner refiner(editor, criteria, {sample.pslg.centre, true, 0, 0}, context);
    const auto done = refiner.run();
    if (!done) continue;  // some random models ask for more than this
    EXPECT_EQ(fault(wanted, measure_segment_cover(sample.mesh())), "");
    EXPECT_GE(sample.mesh().triangle_count(), 1U);
  }
}

TEST(SegmentCover, FindsDamage) {
  int moved = 0;
  for (test::QuotientSample& sample : samples()) {
    const SegmentCover wanted = measure_segment_cover(sample.mesh());
    // A vertex elsewhere.
    for (std::size_t i = 0; i < sample.mesh().vertex_slots(); ++i) {
      const auto v = static_cast<VertexId>(i);
      if (sample.mesh().corner_of(v) == kNoHalfEdge || v == sample.mesh().centre()) continue;
      if (sample.mesh().kind(v) != VertexKind::kInput) continue;
      QuotientTriangulation mesh = sample.mesh();
      const Point2 p = mesh.point(v);
      mesh.move_vertex(v, {p.x + 1e-3 * length(p), p.y + 2e-3 * length(p)});
      const auto found = fault(wanted, measure_segment_cover(mesh));
      moved += found != "" ? 1 : 0;
    }
    for (std::size_t s = 0; s < wanted.segments.size(); ++s) {
      SegmentCover damaged = wanted;
      damaged.segments[s].one_sided *= 1 - 1e-6;
      damaged.segments[s].two_sided *= 1 - 1e-6;
      EXPECT_NE(fault(wanted, damaged), "");
      damaged = wanted;
      std::swap(damaged.segments[s].one_sided, damaged.segments[s].two_sided);
      EXPECT_NE(fault(wanted, damaged), "");
    }
    SegmentCover damaged = wanted;
    damaged.area *= 1 + 1e-6;
    EXPECT_NE(fault(wanted, damaged).find("area"), std::string::npos);
    damaged = wanted;
    --damaged.euler;
    EXPECT_NE(fault(wanted, damaged).find("Euler"), std::string::npos);
    damaged = wanted;
    damaged.segments.push_back({1, 0});
    EXPECT_NE(fault(wanted, damaged), "");
    damaged.segments.resize(wanted.segments.size() - 1);
    EXPECT_NE(fault(wanted, damaged), "");
  }
  EXPECT_GT(moved, 50);
}

// Triangles and subsegments that are gone, or there twice.
TEST(SegmentCover, FindsTrianglesAndSubsegmentsThatAreGone) {
  for (test::QuotientSample& sample : samples()) {
    const SegmentCover wanted = measure_segment_cover(sample.mesh());
    for (const TriangleId t : test::live_triangles(sample.mesh())) {
      QuotientTriangulation mesh = sample.mesh();
      mesh.triangle(t).face = -1;
      EXPECT_NE(fault(wanted, measure_segment_cover(mesh)), "");
      for (std::uint32_t j = 0; j < 3; ++j) {
        if (sample.mesh().triangle(t).seg[j] == kNoSubsegment) continue;
        const HalfEdge g = sample.mesh().triangle(t).nb[j];
        if (g != kNoHalfEdge && g < 3 * t + j) continue;  // counted at the other side
        mesh = sample.mesh();
        mesh.triangle(t).seg[j] = kNoSubsegment;
        EXPECT_NE(fault(wanted, measure_segment_cover(mesh)), "");
      }
    }
  }
}

}  // namespace
}  // namespace symcell::plane
