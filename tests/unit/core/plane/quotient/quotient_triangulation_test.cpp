#include <algorithm>
#include <array>
#include <set>

#include "core/plane/delaunay/insert.hpp"
#include "core/plane/quotient/star.hpp"
#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

using test::Dice;
using test::QuotientSample;

// Triangles as cycles of corners, each turned to begin with its smallest, in the frame where that
// has exponent 0: what two meshes with other slots and gauges have in common.
using Cycle = std::array<std::pair<VertexId, std::int32_t>, 3>;

std::multiset<Cycle> cycles(const QuotientTriangulation& mesh) {
  std::multiset<Cycle> result;
  for (const TriangleId t : test::live_triangles(mesh)) {
    const Triangle& tri = mesh.triangle(t);
    Cycle best{};
    for (std::uint32_t first = 0; first < 3; ++first) {
      if (tri.v[first] == mesh.centre()) continue;
      const std::int32_t back = mesh.subtract(0, tri.k[first]);
      Cycle cycle{};
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t c = (first + i) % 3;
        cycle[i] = {tri.v[c], mesh.shift(tri.v[c], tri.k[c], back)};
      }
      if (best == Cycle{} || cycle < best) best = cycle;
    }
    result.insert(best);
  }
  return result;
}

void insert_random_points(QuotientTriangulation& mesh, std::uint64_t seed, int count) {
  Editor editor(mesh);
  Dice dice(seed);
  Cavity cavity;
  for (int i = 0; i < count; ++i) {
    const TriangleId t = dice.triangle(mesh);
    const Point2 x = dice.point_in(mesh, t);
    editor.compute_cavity(t, x, cavity);
    static_cast<void>(editor.insert_in_cavity(t, x, cavity, VertexKind::kFree));
  }
}

TEST(QuotientTriangulation, InitialMeshesAreValid) {
  for (const std::int32_t fold : {1, 2, 3, 4, 7, 24}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      test::expect_delaunay(test::random_sample(seed, fold).mesh());
    }
  }
}

// A ring with one vertex a sector on either side has two orbits of triangles, which share two
// edges.
TEST(QuotientTriangulation, FlipOfTrianglesThatShareTwoEdges) {
  for (const std::int32_t fold : {3, 4, 6, 7, 12}) {
    QuotientSample ring = test::triangulated(regular_ring(fold, 2, 1.2), fold);
    QuotientTriangulation& mesh = ring.mesh();
    ASSERT_EQ(mesh.triangle_count(), 2U);
    const auto before = cycles(mesh);
    int flipped = 0;
    for (HalfEdge h = 0; h < 3; ++h) {
      const HalfEdge g = mesh.triangle(0).nb[h];
      if (g == kNoHalfEdge) continue;
      // Only one of the two is the diagonal of a convex quadrilateral.
      const Triangle& t = mesh.triangle(0);
      const Triangle& u = mesh.triangle(triangle_of(g));
      const Point2 p = mesh.corner_point(t, h), a = mesh.corner_point(t, next3(h)),
                   b = mesh.corner_point(t, prev3(h));
      const Point2 q = mesh.lift(u.v[local_of(g)], mesh.add(u.k[local_of(g)], t.off[h]));
      if (cross(a - p, q - p) <= 1e-9 || cross(q - p, b - p) <= 1e-9) continue;
      const HalfEdge diagonal = mesh.flip(h);
      ++flipped;
      test::expect_delaunay(mesh);  // the quadrilateral is a trapezium: either diagonal will do
      EXPECT_NE(cycles(mesh), before);
      mesh.flip(diagonal);
      test::expect_delaunay(mesh);
      EXPECT_EQ(cycles(mesh), before);
      break;
    }
    EXPECT_EQ(flipped, 1) << "fold " << fold;
  }
}

TEST(QuotientTriangulation, FlippingTwiceRestoresTheTriangles) {
  for (const std::int32_t fold : {1, 2, 5, 8}) {
    QuotientSample sample = test::random_sample(3, fold);
    QuotientTriangulation& mesh = sample.mesh();
    insert_random_points(mesh, 7, 20);
    const auto before = cycles(mesh);
    for (const TriangleId t : test::live_triangles(mesh)) {
      for (std::uint32_t j = 0; j < 3; ++j) {
        const Triangle tri = mesh.triangle(t);
        const HalfEdge g = tri.nb[j];
        if (g == kNoHalfEdge || tri.seg[j] != kNoSubsegment || triangle_of(g) == t) continue;
        const HalfEdge once = mesh.flip(3 * t + j);
        const auto incidence = validate(mesh, ValidationLevel::kIncidence);
        ASSERT_TRUE(incidence) << incidence.error().message;
        mesh.flip(once);
        ASSERT_EQ(cycles(mesh), before) << "fold " << fold << ", triangle " << t << ", edge " << j;
      }
    }
    test::expect_delaunay(mesh);
  }
}

TEST(QuotientTriangulation, RollbackRestoresAndCommitKeeps) {
  for (const std::int32_t fold : {1, 2, 6, 17}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      QuotientSample sample = test::random_sample(seed, fold);
      QuotientTriangulation& mesh = sample.mesh();
      insert_random_points(mesh, seed, 10);
      const QuotientTriangulation before = mesh;
      mesh.begin();
      insert_random_points(mesh, seed + 100, 15);
      EXPECT_FALSE(test::same_content(mesh, before));
      mesh.roll_back();
      EXPECT_TRUE(test::same_content(mesh, before));
      test::expect_delaunay(mesh);

      // What follows a roll_back, and what is committed, is as if nothing had been.
      QuotientTriangulation plain = before;
      insert_random_points(plain, seed + 200, 15);
      mesh.begin();
      insert_random_points(mesh, seed + 200, 15);
      mesh.commit();
      EXPECT_TRUE(test::same_content(mesh, plain));
      test::expect_delaunay(mesh);
    }
  }
}

TEST(QuotientTriangulation, CompactKeepsTheTriangles) {
  QuotientSample sample = test::random_sample(5, 6);
  QuotientTriangulation& mesh = sample.mesh();
  insert_random_points(mesh, 1, 60);
  const auto before = cycles(mesh);
  mesh.compact();
  EXPECT_EQ(mesh.triangle_slots(), mesh.triangle_count());
  EXPECT_EQ(cycles(mesh), before);
  test::expect_delaunay(mesh);
  insert_random_points(mesh, 2, 20);
  test::expect_delaunay(mesh);
}

TEST(Star, WalksVisitEveryCornerOnceInOrder) {
  for (const std::int32_t fold : {1, 2, 3, 5, 12}) {
    QuotientSample sample = test::random_sample(11, fold);
    QuotientTriangulation& mesh = sample.mesh();
    insert_random_points(mesh, 3, 30);
    std::set<HalfEdge> seen;
    for (std::size_t id = 0; id < mesh.vertex_slots(); ++id) {
      const auto v = static_cast<VertexId>(id);
      if (mesh.corner_of(v) == kNoHalfEdge) continue;
      StarItem item = star_item(mesh, mesh.corner_of(v));
      const bool open = to_star_begin(mesh, item);
      const StarItem begin = item;
      double angle = 0;
      for (;;) {
        const Triangle& tri = mesh.triangle(item.t);
        ASSERT_EQ(tri.v[item.i], v);
        ASSERT_EQ(mesh.shift(v, tri.k[item.i], item.e), 0);
        // A vertex where pieces of the domain meet has several stars: only one is walked.
        ASSERT_TRUE(seen.insert(3 * item.t + item.i).second);
        const OrbitVertex a = star_corner(mesh, item, 1), b = star_corner(mesh, item, 2);
        const Point2 p = mesh.lift(a.orbit, a.exponent) - mesh.point(v),
                     q = mesh.lift(b.orbit, b.exponent) - mesh.point(v);
        ASSERT_GT(cross(p, q), 0);
        angle += std::atan2(cross(p, q), dot(p, q));
        const StarItem last = item;
        if (!rotate_ccw(mesh, item)) {
          EXPECT_TRUE(open);
          break;
        }
        EXPECT_EQ(star_corner(mesh, item, 1), b);
        StarItem back = item;
        ASSERT_TRUE(rotate_cw(mesh, back));
        EXPECT_TRUE(back.t == last.t && back.i == last.i);
        if (item.t == begin.t && item.i == begin.i) {
          EXPECT_FALSE(open);
          break;
        }
      }
      if (!open) {
        const double turns = v == mesh.centre() ? 1.0 / fold : 1.0;
        EXPECT_NEAR(angle, 2 * M_PI * turns, 1e-9);
      }
    }
    EXPECT_EQ(seen.size(), 3 * mesh.triangle_count());
  }
}

}  // namespace
}  // namespace symcell::plane
