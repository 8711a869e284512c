// The cut of the quotient into a cell: against all ways there are, for meshes small enough.
#include "core/plane/cut/cut_cell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "core/plane/refine/refiner.hpp"
#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

using test::QuotientSample;

// Triangles that fit their neighbour across half-edge h when they stand at these exponents.
bool fits(const QuotientTriangulation& mesh,
          HalfEdge h,
          const std::vector<std::int32_t>& exponent) {
  const Triangle& t = mesh.triangle(triangle_of(h));
  return mesh.add(exponent[triangle_of(h)], t.off[local_of(h)]) ==
         exponent[triangle_of(t.nb[local_of(h)])];
}

// Edges of the bounds of the cell in which triangles stand at these exponents; as many as can be
// if a component of the mesh falls apart.
std::size_t bound_edges(const QuotientTriangulation& mesh,
                        const std::vector<std::int32_t>& exponent,
                        std::size_t components) {
  const std::vector<TriangleId> live = test::live_triangles(mesh);
  std::vector<char> seen(mesh.triangle_slots(), 0);
  std::size_t cuts = 0, pieces = 0;
  for (const TriangleId seed : live) {
    if (seen[seed] != 0) continue;
    ++pieces;
    std::vector<TriangleId> stack{seed};
    seen[seed] = 1;
    while (!stack.empty()) {
      const TriangleId t = stack.back();
      stack.pop_back();
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        const HalfEdge g = mesh.triangle(t).nb[local_of(h)];
        if (g == kNoHalfEdge) continue;
        if (!fits(mesh, h, exponent)) {
          cuts += h < g ? 1 : 0;
        } else if (seen[triangle_of(g)] == 0) {
          seen[triangle_of(g)] = 1;
          stack.push_back(triangle_of(g));
        }
      }
    }
  }
  return pieces == components ? cuts : std::numeric_limits<std::size_t>::max();
}

std::size_t component_count(const QuotientTriangulation& mesh) {
  std::vector<char> seen(mesh.triangle_slots(), 0);
  std::size_t count = 0;
  for (const TriangleId seed : test::live_triangles(mesh)) {
    if (seen[seed] != 0) continue;
    ++count;
    std::vector<TriangleId> stack{seed};
    seen[seed] = 1;
    while (!stack.empty()) {
      const TriangleId t = stack.back();
      stack.pop_back();
      for (const HalfEdge g : mesh.triangle(t).nb) {
        if (g == kNoHalfEdge || seen[triangle_of(g)] != 0) continue;
        seen[triangle_of(g)] = 1;
        stack.push_back(triangle_of(g));
      }
    }
  }
  return count;
}

// The fewest bound edges of any choice of exponents: n^(T-1) of them.
std::size_t fewest_bound_edges(const QuotientTriangulation& mesh) {
  const std::vector<TriangleId> live = test::live_triangles(mesh);
  const std::size_t components = component_count(mesh);
  std::vector<std::int32_t> exponent(mesh.triangle_slots(), 0);
  std::size_t best = std::numeric_limits<std::size_t>::max();
  for (;;) {
    best = std::min(best, bound_edges(mesh, exponent, components));
    std::size_t i = 1;  // the first stays: all may be turned together
    while (i < live.size() && ++exponent[live[i]] == mesh.fold()) exponent[live[i++]] = 0;
    if (i >= live.size()) return best;
  }
}

// The cut is what its exponents make, all of it once.
void expect_consistent(const QuotientTriangulation& mesh, const CellCut& cut) {
  const std::size_t edges = bound_edges(mesh, cut.exponent, component_count(mesh));
  EXPECT_EQ(cut.lower.size(), edges);
  for (const HalfEdge h : cut.lower) {
    EXPECT_FALSE(fits(mesh, h, cut.exponent));
    // The triangle beyond stands one sector back.
    const Triangle& t = mesh.triangle(triangle_of(h));
    EXPECT_EQ(mesh.add(cut.exponent[triangle_of(h)], t.off[local_of(h)]),
              mesh.subtract(cut.exponent[triangle_of(t.nb[local_of(h)])], 1));
  }
}

TEST(CutCell, HasTheFewestSymmetryEdgesThereAre) {
  constexpr double kMostChoices = 300'000;
  std::map<std::int32_t, int> compared;
  for (const std::int32_t fold : {2, 3, 4, 5, 6}) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      QuotientSample sample = test::random_sample(seed, fold);
      const QuotientTriangulation& mesh = sample.mesh();
      const double choices = std::pow(fold, static_cast<double>(mesh.triangle_count()) - 1);
      if (choices > kMostChoices) continue;
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      const auto cut = cut_cell(mesh);
      ASSERT_TRUE(cut) << cut.error().message;
      EXPECT_EQ(cut->lower.size(), fewest_bound_edges(mesh));
      expect_consistent(mesh, *cut);
      ++compared[fold];
    }
  }
  for (const std::int32_t fold : {2, 3, 4}) EXPECT_GT(compared[fold], 3) << "fold " << fold;
}

TEST(CutCell, RefinedMeshesUnrollIntoOnePieceAComponent) {
  for (const std::int32_t fold : {1, 2, 3, 8, 36}) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      QuotientSample sample = test::random_sample(seed, fold);
      MeshOptions options;
      options.min_angle_deg = 20;
      Criteria criteria(sample.mesh(), sample.start.subdomains, options);
      Editor editor(sample.mesh());
      ExecutionContext context;
      Refiner refiner(editor, criteria, {}, context);
      ASSERT_TRUE(refiner.run());
      const auto cut = cut_cell(sample.mesh());
      ASSERT_TRUE(cut) << cut.error().message;
      expect_consistent(sample.mesh(), *cut);
      EXPECT_EQ(cut->lower.empty(), fold == 1);
      test::expect_delaunay(sample.mesh());
    }
  }
}

// Holes with a tip at the centre: what winds about it goes through it.
Point2 polar(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

TEST(CutCell, HolesThatMeetAtTheCentre) {
  for (const std::int32_t fold : {2, 3, 5, 8}) {
    for (const double share : {0.1, 0.45, 0.9}) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " share " + std::to_string(share));
      const double angle = share * std::numbers::pi / fold;  // half of a hole's
      SectorBuilder builder(fold);
      builder.add_loop({builder.add_vertex({9, 0}), builder.add_vertex(polar(9, 1.0 / fold))}, 1);
      const auto o = builder.add_centre();
      const auto a = builder.add_vertex(polar(1, -angle)), b = builder.add_vertex(polar(1, angle));
      builder.add_closed({o, a, b}, 2);
      builder.add_hole({0.5 * std::cos(angle), 0});
      QuotientSample sample = test::triangulated(builder.pslg(), fold);
      const auto cut = cut_cell(sample.mesh());
      ASSERT_TRUE(cut) << cut.error().message;
      EXPECT_EQ(cut->lower.size(), 1U);
      expect_consistent(sample.mesh(), *cut);
    }
  }
}

TEST(CutCell, PiecesThatDoNotWrapHaveNoBounds) {
  for (const std::int32_t fold : {2, 4, 7}) {
    QuotientSample sample = test::pads(fold);
    const auto cut = cut_cell(sample.mesh());
    ASSERT_TRUE(cut) << cut.error().message;
    EXPECT_TRUE(cut->lower.empty());
    expect_consistent(sample.mesh(), *cut);
  }
}

}  // namespace
}  // namespace symcell::plane
