// How well a rotation maps a PLC onto itself: the error is that of the vertex farthest off,
// and everything but places must agree exactly.
#include "core/solid/symmetry/plc_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/rotation.hpp"
#include "tests/support/plc_builders.hpp"

namespace symcell::solid {
namespace {

constexpr double kTolerance = 1e-4;

struct Model {
  PlcComplex complex;
  PlcCells cells;
  bool ignore_markers = false;

  explicit Model(const Plc& plc, bool ignore = false) : ignore_markers(ignore) {
    ExecutionContext context;
    auto made = make_plc_complex(plc, context);
    EXPECT_TRUE(made) << made.error().message;
    if (made) complex = std::move(*made);
    auto found = find_cells(complex, context);
    EXPECT_TRUE(found) << found.error().message;
    if (found) cells = std::move(*found);
  }
  [[nodiscard]] PlcFit fit(std::int32_t fold,
                           const AxisFrame& frame = {},
                           bool adjust = false) const {
    return PlcMatcher(complex, cells, kTolerance, ignore_markers).fit(fold, frame, adjust);
  }
};

// A ring of vertices round the z axis and two on it, 2 * corners triangles: whatever vertex is
// moved, all facets stay planar.
Plc bipyramid(std::int32_t corners) {
  Plc plc;
  for (std::int32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    plc.vertices.push_back({std::cos(angle), std::sin(angle), 0});
    const std::int32_t j = (i + 1) % corners;
    for (const std::int32_t tip : {corners, corners + 1}) {
      PlcFacet facet;
      facet.polygons = {{i, j, tip}};
      facet.marker = 1;
      plc.facets.push_back(facet);
    }
  }
  plc.vertices.push_back({0, 0, 1.3});
  plc.vertices.push_back({0, 0, -0.8});
  return plc;
}

void expect_orbits(const Model& model, const PlcFit& fit) {
  const RotationTable rotations(fit.fold);
  ASSERT_EQ(fit.vertex.size(), model.complex.points.size());
  std::vector<std::int32_t> first(fit.on_axis.size(), -1);
  std::vector<std::set<std::int32_t>> exponents(fit.on_axis.size());
  std::int32_t next = 0;
  for (std::size_t i = 0; i < fit.vertex.size(); ++i) {
    const OrbitVertex v = fit.vertex[i];
    if (first[v.orbit] < 0) {
      EXPECT_EQ(v.orbit, next++);
      EXPECT_EQ(v.exponent, 0);
      first[v.orbit] = static_cast<std::int32_t>(i);
    }
    EXPECT_TRUE(exponents[v.orbit].insert(v.exponent).second);
    const Point3 base = fit.frame.to_local(model.complex.points[first[v.orbit]]);
    const Point3 image = fit.frame.to_model(rotations.rotate(base, v.exponent));
    EXPECT_LE(distance(image, model.complex.points[i]), fit.error + 1e-12);
  }
  for (std::size_t o = 0; o < fit.on_axis.size(); ++o) {
    EXPECT_EQ(exponents[o].size(), fit.on_axis[o] != 0 ? 1U : static_cast<std::size_t>(fit.fold));
  }
}

TEST(PlcFit, ARotatedCopyFits) {
  Random random(1);
  for (const std::int32_t n : {3, 4, 6, 12, 31}) {
    for (const bool tips : {false, true}) {
      Plc plc = tips ? bipyramid(n) : test::prism(n, 1, 2.7);
      const Point3 origin{10 * random.uniform(), -3, 5};
      const AxisFrame frame = AxisFrame::of_axis(origin, {random.uniform(), 1, -random.uniform()});
      for (Point3& p : plc.vertices) p = frame.to_model(p);
      const Model model(plc);
      for (std::int32_t fold = 2; fold <= n + 1; ++fold) {
        const PlcFit fit = model.fit(fold, frame);
        EXPECT_EQ(fit.fold, fold);
        EXPECT_EQ(fit.accepted, n % fold == 0) << n << ' ' << fold;
        if (fit.accepted) {
          EXPECT_LT(fit.error, 1e-13);
          EXPECT_TRUE(fit.mismatch.empty());
          expect_orbits(model, fit);
        } else {
          EXPECT_GT(fit.error, kTolerance);
        }
      }
    }
  }
}

TEST(PlcFit, AMovedVertexIsTheError) {
  Random random(2);
  for (int i = 0; i < 40; ++i) {
    const auto n = 3 + static_cast<std::int32_t>(random.next() % 8);
    const auto v = static_cast<std::size_t>(random.next() % n);
    const double off = kTolerance * (0.01 + 2 * random.uniform());
    const double a = 6 * random.uniform(), b = 3 * random.uniform();
    Plc plc = bipyramid(n);
    const Point3 way{std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b)};
    plc.vertices[v] = plc.vertices[v] + off * way;
    const Model model(plc);
    const PlcFit fit = model.fit(n);
    EXPECT_NEAR(fit.error, off, 1e-14);
    EXPECT_EQ(fit.accepted, off <= kTolerance);
    EXPECT_TRUE(fit.mismatch.empty());
    EXPECT_LT(fit.worst_vertex, n);  // it or the one it is turned onto
    if (fit.accepted) expect_orbits(model, fit);
  }
}

// Within the tolerance of the axis a vertex is on it.
TEST(PlcFit, AVertexBesideTheAxis) {
  for (const double off : {0.5 * kTolerance, 3 * kTolerance}) {
    Plc plc = bipyramid(6);
    plc.vertices[6].x = off;
    const Model model(plc);
    const PlcFit fit = model.fit(6);
    EXPECT_EQ(fit.accepted, off < kTolerance);
    EXPECT_EQ(fit.worst_vertex, 6);
    EXPECT_GE(fit.error, 0.99 * off);
    EXPECT_LE(fit.error, 2.01 * off);
    if (!fit.accepted) continue;
    expect_orbits(model, fit);
    EXPECT_EQ(fit.on_axis[fit.vertex[6].orbit], 1);
  }
}

TEST(PlcFit, AGuessedAxisIsAdjusted) {
  Random random(3);
  for (const std::int32_t n : {3, 6, 11}) {
    for (int i = 0; i < 6; ++i) {
      const Model model(bipyramid(n));
      const auto some = [&] { return 2 * kTolerance * (0.5 + random.uniform()); };
      const AxisFrame guess = AxisFrame::of_axis({some(), -some(), 0}, {some(), some(), 1});
      EXPECT_FALSE(model.fit(n, guess).accepted);
      const PlcFit fit = model.fit(n, guess, true);
      EXPECT_TRUE(fit.accepted);
      EXPECT_LT(fit.error, 1e-9);
      const Point3 d = fit.frame.direction();
      EXPECT_LT(std::hypot(d.x, d.y), 1e-9);
      EXPECT_LT(std::hypot(fit.frame.origin.x, fit.frame.origin.y), 1e-9);
    }
  }
}

TEST(PlcFit, MarkersTakePartUnlessIgnored) {
  Plc plc = test::prism(6, 1, 2);
  plc.facets[4].marker = 9;
  for (const bool ignore : {false, true}) {
    const PlcFit fit = Model(plc, ignore).fit(6);
    EXPECT_EQ(fit.accepted, ignore);
    EXPECT_EQ(fit.mismatch.empty(), ignore);
    if (ignore) continue;
    EXPECT_LT(fit.error, 1e-13);
    EXPECT_EQ(std::set<std::int64_t>(fit.elements.begin(), fit.elements.end()).count(4), 1U);
  }
  plc.facets[7].marker = 9;  // opposite to it
  EXPECT_TRUE(Model(plc).fit(2).accepted);
  EXPECT_FALSE(Model(plc).fit(3).accepted);
}

// Two boxes on either side of the axis: half a turn, unless one of them is filled differently.
TEST(PlcFit, CellsTakePart) {
  Plc plc;
  test::add_box(plc, {1, -0.5, 0}, {2, 0.5, 1});
  test::add_box(plc, {-2, -0.5, 0}, {-1, 0.5, 1});
  EXPECT_TRUE(Model(plc).fit(2).accepted);
  plc.regions.push_back({{1.4, 0.1, 0.3}, 5});
  EXPECT_FALSE(Model(plc).fit(2).accepted);
  EXPECT_TRUE(Model(plc, true).fit(2).accepted);
  plc.regions.push_back({{-1.7, 0.2, 0.9}, 5});
  EXPECT_TRUE(Model(plc).fit(2).accepted);
  plc.regions.back().max_volume = 0.1;
  EXPECT_FALSE(Model(plc).fit(2).accepted);
  plc.regions.clear();
  plc.holes.push_back({1.4, 0.1, 0.3});
  // A hole is no marker.
  for (const bool ignore : {false, true}) {
    const PlcFit fit = Model(plc, ignore).fit(2);
    EXPECT_FALSE(fit.accepted);
    EXPECT_NE(fit.mismatch.find("hole of seed 0"), std::string::npos) << fit.mismatch;
  }
}

// Whichever way a facet's polygon runs: its sides are still those of the cells.
TEST(PlcFit, FacetsMayRunEitherWay) {
  Plc plc = test::prism(6, 1, 2);
  for (const std::size_t f : {2U, 3U, 6U}) {
    auto& polygon = plc.facets[f].polygons.front();
    std::reverse(polygon.begin(), polygon.end());
  }
  EXPECT_TRUE(Model(plc).fit(6).accepted);
}

TEST(MapComplex, TellsTheImagesOfEdgesAndFacets) {
  constexpr std::int32_t kCorners = 7;
  const Model model(test::prism(kCorners, 1, 2));
  std::vector<std::int32_t> image;
  for (std::int32_t i = 0; i < 2 * kCorners; ++i) {
    image.push_back(i < kCorners ? (i + 1) % kCorners : kCorners + (i + 1) % kCorners);
  }
  const ComplexImage mapped = map_complex(model.complex, image, false);
  ASSERT_FALSE(mapped.mismatch) << *mapped.mismatch;
  ASSERT_EQ(mapped.edge.size(), model.complex.edges.size());
  for (std::size_t e = 0; e < mapped.edge.size(); ++e) {
    const ComplexEdge& from = model.complex.edges[e];
    const ComplexEdge& to = model.complex.edges[mapped.edge[e]];
    EXPECT_EQ((std::set{image[from.a], image[from.b]}), (std::set{to.a, to.b}));
  }
  // Bottom, top, then the sides in turn.
  EXPECT_EQ(mapped.facet, (std::vector<std::int32_t>{0, 1, 3, 4, 5, 6, 7, 8, 2}));
  // One level turned against the other: upright edges have no image.
  std::vector<std::int32_t> sheared = image;
  for (std::int32_t i = 0; i < kCorners; ++i) sheared[i] = i;
  const ComplexImage none = map_complex(model.complex, sheared, false);
  ASSERT_TRUE(none.mismatch);
  ASSERT_EQ(none.elements.size(), 4U);
  EXPECT_EQ(none.elements[1], none.elements[0] + kCorners);
}

}  // namespace
}  // namespace symcell::solid
