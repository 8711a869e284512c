// Facets with gaps beyond which there is material again: points in them never lay a subfacet across
// the gap; edits whose outlines differ are refused where segments are split, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/solid/quotient/constraints.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "tests/support/plc_builders.hpp"
#include "tests/unit/core/solid/solid_checks.hpp"

namespace symcell::solid {
namespace {

InitialTetrahedralization tetrahedralized(const Plc& plc, std::int32_t fold) {
  ExecutionContext context;
  MeshOptions options;
  options.fold = fold;
  const auto source = symmetrise_plc(plc, options, context);
  EXPECT_TRUE(source) << source.error().message;
  if (!source) return {};
  Error last;
  for (std::int32_t i = 0; i < (*source)->candidates(); ++i) {
    const auto sector = (*source)->sector(i, context);
    auto solid = sector ? tetrahedralize_sector(*sector, context) : error_of(sector);
    if (solid) return std::move(*solid);
    last = solid.error();
  }
  ADD_FAILURE() << last.message;
  return {};
}

std::string cover_fault(const InitialTetrahedralization& solid) {
  const auto cover = measure_facet_cover(constraints_of(solid.mesh, solid.axis_segment()));
  if (!cover) return cover.error().message;
  const auto same = compare_facet_covers(solid.cover, *cover, solid.diameter);
  return same ? "" : same.error().message;
}

struct Place {
  Location where;
  Point3 p;
};

// Inside, on an edge or on a subfacet, drawn at random; those of the facet with the slots most
// often. Points on their rims make the tetrahedra that lead a cavity round a gap.
Place random_place(const InitialTetrahedralization& solid, Random& random) {
  constexpr std::int32_t kSlotted = 2;  // its marker
  const QuotientTetrahedralization& mesh = solid.mesh;
  const std::vector<TetId> tets = test::live_tets(mesh);
  const TetId t = tets[static_cast<std::size_t>(random.next() % tets.size())];
  const auto kind = random.next() % 6;
  if (kind == 0) {
    Point3 p;
    for (std::uint32_t i = 0; i < 4; ++i) p = p + 0.25 * mesh.corner_point(t, i);
    return {{Location::Kind::kInside, {t, 0}, 0, {}}, p};
  }
  if (kind == 1) {
    auto [where, p] = test::middle_of_edge(mesh, t, static_cast<std::size_t>(random.next() % 6));
    const Point3 way = mesh.lift(where.edge[1]) - mesh.lift(where.edge[0]);
    return {where, p + 0.4 * (random.uniform() - 0.5) * way};
  }
  std::vector<HalfFace> list;
  for (const TetId x : tets) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::int32_t facet = mesh.tet(x).facet[i];
      if (facet == kNoFacet) continue;
      const auto marker = solid.facet_markers[static_cast<std::size_t>(facet)];
      if (kind == 2 || marker == kSlotted) list.push_back(4 * x + i);
    }
  }
  const HalfFace h = list[static_cast<std::size_t>(random.next() % list.size())];
  const double u = 0.05 + 0.85 * random.uniform(), v = (0.95 - u) * random.uniform() + 0.02;
  const auto x = [&](std::size_t i) {
    return mesh.corner_point(tet_of(h), kFaceCorners[face_of(h)][i]);
  };
  return {{Location::Kind::kOnSubfacet, {tet_of(h), 0}, face_of(h), {}},
          u * x(0) + v * x(1) + (1 - u - v) * x(2)};
}

class SlottedFacet : public testing::TestWithParam<std::array<std::int32_t, 3>> {};

// Sides, a rib on every how many, fold.
INSTANTIATE_TEST_SUITE_P(Shapes,
                         SlottedFacet,
                         testing::Values(std::array{4, 4, 1},
                                         std::array{4, 2, 1},
                                         std::array{4, 2, 2},
                                         std::array{4, 1, 4},
                                         std::array{6, 2, 3},
                                         std::array{6, 1, 6}));

TEST_P(SlottedFacet, PointsRoundTheGapLeaveItOpen) {
  const auto [sides, every, fold] = GetParam();
  int done = 0;
  for (const double half_width : {0.02, 0.1, 0.5}) {
    test::RibbedShape shape;
    shape.sides = sides;
    shape.every = every;
    shape.half_width = half_width;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      InitialTetrahedralization solid = tetrahedralized(test::ribbed_prism(shape), fold);
      test::shuffle_gauge(solid.mesh, seed);
      ASSERT_EQ(cover_fault(solid), "");
      Editor editor(solid.mesh);
      const double volume = test::quotient_volume(solid.mesh);
      EXPECT_NEAR(volume * fold, test::ribbed_volume(shape), 1e-9 * volume);
      Random random(seed);
      for (int i = 0; i < 60; ++i) {
        const Place place = random_place(solid, random);
        const VertexId v = test::insert_point(editor, place.where, place.p);
        if (v == Editor::kNoVertex) continue;
        ++done;
        const std::string fault = cover_fault(solid);
        ASSERT_EQ(fault, "") << "seed " << seed << ", point " << i;
        ASSERT_TRUE(test::is_valid(solid.mesh, volume)) << "seed " << seed << ", point " << i;
      }
    }
  }
  EXPECT_GT(done, 360);
}

// The tetrahedra at a segment's edge and the halves they are cut into by its middle.
struct Split {
  std::vector<TetCopy> removed;
  std::vector<NewTet> added;
  std::array<EdgeKey, 3> edges{};  // the whole, its halves
};

Split split_of(
    const QuotientTetrahedralization& mesh, TetId t, OrbitVertex a, OrbitVertex b, OrbitVertex p) {
  Split s;
  static_cast<void>(mesh.ring({t, 0}, a, b, s.removed));
  for (const TetCopy& c : s.removed) {
    for (const OrbitVertex gone : {a, b}) {
      NewTet n;
      n.region = mesh.tet(c.t).region;
      for (std::uint32_t i = 0; i < 4; ++i) {
        n.c[i] = mesh.corner(c, i);
        n.facet[i] = mesh.tet(c.t).facet[i];
        if (n.c[i] == gone) n.c[i] = p;
      }
      // The face between the two halves is of no facet; that opposite `gone` stays as it is.
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (mesh.corner(c, i) == (gone == a ? b : a)) n.facet[i] = kNoFacet;
      }
      s.added.push_back(n);
    }
  }
  s.edges = {mesh.edge_key(a, b), mesh.edge_key(a, p), mesh.edge_key(p, b)};
  return s;
}

// Copies of one facet on both sides have no outline there.
bool bounds_a_facet(const QuotientTetrahedralization& mesh,
                    const Split& s,
                    OrbitVertex a,
                    OrbitVertex b) {
  std::map<std::int32_t, int> subfacets;
  for (const TetCopy& c : s.removed) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const OrbitVertex x = mesh.corner(c, i);
      const Tet& t = mesh.tet(c.t);
      if (x == a || x == b || t.facet[i] == kNoFacet) continue;
      subfacets[t.facet[i]] += t.nb[i] == kNoHalfFace ? 2 : 1;  // halves
    }
  }
  return std::any_of(subfacets.begin(), subfacets.end(),
                     [](const auto& entry) { return entry.second % 4 != 0; });
}

class SegmentSplit : public testing::TestWithParam<std::int32_t> {};
INSTANTIATE_TEST_SUITE_P(Folds, SegmentSplit, testing::Values(1, 2, 3, 6, 12));

TEST_P(SegmentSplit, ReplaceComparesOutlinesElsewhere) {
  int split = 0, refused = 0, outlines = 0;
  test::PrismShape shape = test::prism_shape(GetParam());
  shape.inner_facet = true;
  const InitialTetrahedralization given = test::prism(shape);
  const double volume = test::quotient_volume(given.mesh);
  for (const TetId t : test::live_tets(given.mesh)) {
    for (const auto& e : kEdgeCorners) {
      QuotientTetrahedralization mesh = given.mesh;
      const OrbitVertex a = mesh.corner(t, e[0]), b = mesh.corner(t, e[1]);
      const std::int32_t segment = mesh.segment_of(a, b);
      if (segment == kNoSegment || (mesh.on_axis(a.orbit) && mesh.on_axis(b.orbit))) continue;
      const Point3 middle = 0.5 * (mesh.lift(a) + mesh.lift(b));
      const OrbitVertex p{mesh.add_vertex(middle, VertexKind::kSegment, false, segment), 0};
      const Split s = split_of(mesh, t, a, b, p);
      const auto before = test::fingerprint(mesh);
      if (bounds_a_facet(mesh, s, a, b)) {
        EXPECT_FALSE(mesh.replace(s.removed, s.added));
        EXPECT_FALSE(mesh.replace(s.removed, s.added, std::span(s.edges).first(2)));
        EXPECT_FALSE(mesh.replace(s.removed, s.added, std::span(s.edges).last(2)));
        ++outlines;
      }
      // Another facet, or none, in place of one of the new subfacets.
      for (std::size_t n = 0; n < s.added.size(); ++n) {
        for (std::uint32_t i = 0; i < 4; ++i) {
          const NewTet& whole = s.added[n];
          if (whole.facet[i] == kNoFacet || whole.c[i] == p) continue;
          for (const std::int32_t other : {kNoFacet, whole.facet[i] == 0 ? 1 : 0}) {
            std::vector<NewTet> added = s.added;
            added[n].facet[i] = other;
            EXPECT_FALSE(mesh.replace(s.removed, added, s.edges));
            ++refused;
          }
        }
      }
      EXPECT_EQ(before, test::fingerprint(mesh));
      ASSERT_TRUE(mesh.replace(s.removed, s.added, s.edges));
      mesh.set_segment(s.edges[0], kNoSegment);
      mesh.set_segment(s.edges[1], segment);
      mesh.set_segment(s.edges[2], segment);
      EXPECT_TRUE(test::is_valid(mesh, volume));
      ++split;
    }
  }
  EXPECT_GT(split, 5);
  EXPECT_GT(outlines, 5);
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace symcell::solid
