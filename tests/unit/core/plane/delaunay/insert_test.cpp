#include "core/plane/delaunay/insert.hpp"

#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

using test::Dice;
using test::QuotientSample;

VertexId insert_in(Editor& editor, TriangleId t, Point2 x) {
  Cavity cavity;
  editor.compute_cavity(t, x, cavity);
  return editor.insert_in_cavity(t, x, cavity, VertexKind::kFree);
}

VertexId insert_on(Editor& editor, HalfEdge h, double part) {
  const QuotientTriangulation& mesh = editor.mesh();
  const Triangle& t = mesh.triangle(triangle_of(h));
  const Point2 a = mesh.corner_point(t, next3(local_of(h))),
               b = mesh.corner_point(t, prev3(local_of(h)));
  const Point2 x = a + part * (b - a);
  const bool segment = t.seg[local_of(h)] != kNoSubsegment;
  Cavity cavity;
  editor.compute_edge_cavity(h, x, cavity);
  return editor.insert_on_edge(h, x, cavity, segment ? VertexKind::kSegment : VertexKind::kFree);
}

TEST(DelaunayEditor, PointsInTrianglesKeepTheMeshDelaunay) {
  for (const std::int32_t fold : {1, 2, 3, 4, 6, 11, 36}) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      QuotientSample sample = test::random_sample(seed, fold);
      QuotientTriangulation& mesh = sample.mesh();
      const double area = test::area(mesh);
      Editor editor(mesh);
      Dice dice(seed);
      for (int i = 0; i < 40; ++i) {
        const TriangleId t = dice.triangle(mesh);
        const std::size_t triangles = mesh.triangle_count();
        const VertexId v = insert_in(editor, t, dice.point_in(mesh, t));
        ASSERT_EQ(mesh.triangle_count(), triangles + (v >= 0 ? 2 : 0));
        const auto ok = validate(mesh, ValidationLevel::kDelaunay);
        ASSERT_TRUE(ok) << ok.error().message << " after point " << i;
      }
      EXPECT_NEAR(test::area(mesh), area, 1e-12 * area);
    }
  }
}

TEST(DelaunayEditor, PointsOnEdgesSplitThemAndTheirSubsegments) {
  for (const std::int32_t fold : {1, 2, 3, 5, 12, 24}) {
    for (std::uint64_t seed = 20; seed < 24; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      QuotientSample sample = test::random_sample(seed, fold);
      QuotientTriangulation& mesh = sample.mesh();
      const double area = test::area(mesh);
      Editor editor(mesh);
      Dice dice(seed);
      for (int i = 0; i < 40; ++i) {
        const HalfEdge h = 3 * dice.triangle(mesh) + static_cast<HalfEdge>(dice.below(3));
        const Triangle t = mesh.triangle(triangle_of(h));
        const SubsegmentId s = t.seg[local_of(h)];
        const bool boundary = t.nb[local_of(h)] == kNoHalfEdge;
        const std::size_t triangles = mesh.triangle_count();
        const std::size_t subsegments = test::live_subsegments(mesh);
        const VertexId v = insert_on(editor, h, dice.uniform(0.3, 0.7));
        ASSERT_GE(v, 0) << "point " << i;
        EXPECT_EQ(mesh.triangle_count(), triangles + (boundary ? 1 : 2));
        EXPECT_EQ(test::live_subsegments(mesh), subsegments + (s != kNoSubsegment ? 1 : 0));
        const auto ok = validate(mesh, ValidationLevel::kDelaunay);
        ASSERT_TRUE(ok) << ok.error().message << " after point " << i;
      }
      EXPECT_NEAR(test::area(mesh), area, 1e-11 * area);
    }
  }
}

TEST(DelaunayEditor, HalvesOfASubsegmentKeepItsParent) {
  QuotientSample sample = test::triangulated(regular_ring(6, 2, 1), 6);
  QuotientTriangulation& mesh = sample.mesh();
  Editor editor(mesh);
  const SubsegmentId s = 0;
  const std::int32_t parent = mesh.subsegment(s).parent;
  const VertexId v = insert_on(editor, mesh.subsegment(s).half_edge, 0.5);
  ASSERT_GE(v, 0);
  int halves = 0;
  for (std::size_t id = 0; id < mesh.subsegment_slots(); ++id) {
    const Subsegment& half = mesh.subsegment(static_cast<SubsegmentId>(id));
    const Triangle& t = mesh.triangle(triangle_of(half.half_edge));
    const std::uint32_t j = local_of(half.half_edge);
    EXPECT_EQ(t.seg[j], static_cast<SubsegmentId>(id));
    if (t.v[next3(j)] != v && t.v[prev3(j)] != v) continue;
    EXPECT_EQ(half.parent, parent);
    ++halves;
  }
  EXPECT_EQ(halves, 2);
  test::expect_delaunay(mesh);
}

// (o, a, Ra) is its own neighbour: the point splits both of its sides at once.
TEST(DelaunayEditor, SplitOfTheSelfAdjacentTriangle) {
  for (const std::int32_t fold : {3, 4, 5, 6, 7, 12, 29, 100}) {
    for (const bool spokes : {false, true}) {
      for (const std::uint32_t side : {1U, 2U}) {
        SCOPED_TRACE("fold " + std::to_string(fold) + (spokes ? ", spokes" : ""));
        QuotientSample sample = test::wheel(fold, spokes);
        QuotientTriangulation& mesh = sample.mesh();
        ASSERT_EQ(mesh.triangle_count(), 1U);
        const TriangleId t = test::live_triangles(mesh).front();
        std::uint32_t o = 0;
        while (mesh.triangle(t).v[o] != mesh.centre()) ++o;
        const double area = test::area(mesh);
        const std::size_t subsegments = test::live_subsegments(mesh);
        Editor editor(mesh);
        ASSERT_GE(insert_on(editor, 3 * t + (o + side) % 3, 0.4), 0);
        EXPECT_EQ(mesh.triangle_count(), 3U);
        EXPECT_EQ(test::live_subsegments(mesh), subsegments + (spokes ? 1 : 0));
        EXPECT_NEAR(test::area(mesh), area, 1e-14);
        test::expect_delaunay(mesh);
      }
    }
  }
}

// Cavities about the centre meet copies of themselves.
TEST(DelaunayEditor, PointsNearTheCentreFallBackToFlips) {
  for (const std::int32_t fold : {2, 3, 4, 5, 6, 8, 12, 50}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      QuotientSample sample = fold == 2
                                  ? test::triangulated(random_symmetric_pslg(4, 2, nullptr), 2)
                                  : test::wheel(fold, false);
      QuotientTriangulation& mesh = sample.mesh();
      Editor editor(mesh);
      Dice dice(seed);
      int placed = 0;
      for (int i = 0; i < 30; ++i) {
        TriangleId t = dice.triangle(mesh);
        for (const TriangleId u : test::live_triangles(mesh)) {
          for (const VertexId v : mesh.triangle(u).v) t = v == mesh.centre() ? u : t;
        }
        placed += insert_in(editor, t, dice.point_in(mesh, t)) >= 0 ? 1 : 0;
        const auto ok = validate(mesh, ValidationLevel::kDelaunay);
        ASSERT_TRUE(ok) << ok.error().message << " after point " << i;
      }
      EXPECT_GT(placed, 20);
    }
  }
}

TEST(DelaunayEditor, APointAtAVertexChangesNothing) {
  QuotientSample sample = test::random_sample(2, 5);
  QuotientTriangulation& mesh = sample.mesh();
  Editor editor(mesh);
  for (const TriangleId t : test::live_triangles(mesh)) {
    const QuotientTriangulation before = mesh;
    EXPECT_EQ(insert_in(editor, t, mesh.corner_point(mesh.triangle(t), 0)), -1);
    EXPECT_TRUE(test::same_content(mesh, before));
  }
  test::expect_delaunay(mesh);
}

}  // namespace
}  // namespace symcell::plane
