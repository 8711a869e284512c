// Points inserted inside, on subfacets, on subsegments and edges, across copies; edits refused.
#include "core/solid/delaunay/editor.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "core/base/random.hpp"
#include "tests/unit/core/solid/solid_checks.hpp"

namespace symcell::solid {
namespace {

using Kind = Location::Kind;

class SolidEditorFold : public testing::TestWithParam<std::int32_t> {
 protected:
  SolidEditorFold() : solid_(test::prism(shape())), editor_(solid_.mesh) {
    test::shuffle_gauge(solid_.mesh, 3);
    volume_ = test::quotient_volume(mesh());
  }

  static test::PrismShape shape() {
    test::PrismShape s = test::prism_shape(GetParam());
    s.inner_facet = true;
    s.swirl = 0.1;
    return s;
  }

  QuotientTetrahedralization& mesh() { return solid_.mesh; }

  // Whether the point went in; either way the mesh is sound, and as before if it did not.
  bool insert(const Location& where, Point3 p) {
    const auto before = test::fingerprint(mesh());
    const VertexId v = test::insert_point(editor_, where, p);
    if (v == Editor::kNoVertex) {
      EXPECT_EQ(before, test::fingerprint(mesh()));
      return false;
    }
    EXPECT_TRUE(test::is_valid(mesh(), volume_));
    for (const TetId t : mesh().added_ids()) {
      EXPECT_EQ(editor_.measures(t).volume, editor_.measure(t).volume);
    }
    return true;
  }

  std::vector<TetId> tets() { return test::live_tets(mesh()); }

  // Whether no subfacet and no segment holds the edge.
  bool is_inner(TetId t, OrbitVertex a, OrbitVertex b) {
    std::vector<TetCopy> ring;
    if (mesh().segment_of(a, b) != kNoSegment || !mesh().ring({t, 0}, a, b, ring)) return false;
    for (const TetCopy& c : ring) {
      for (std::uint32_t f = 0; f < 4; ++f) {
        const OrbitVertex x = mesh().corner(c, f);
        if (x != a && x != b && mesh().tet(c.t).facet[f] != kNoFacet) return false;
      }
    }
    return true;
  }

  InitialTetrahedralization solid_;
  Editor editor_;
  double volume_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Folds, SolidEditorFold, testing::Values(1, 2, 3, 6, 12));

TEST_P(SolidEditorFold, InsertsInside) {
  int tried = 0, done = 0;
  for (const TetId t : tets()) {
    if (!mesh().alive(t)) continue;
    const auto x = editor_.points({t, 0});
    ++tried;
    done += insert({Kind::kInside, {t, 0}, 0, {}}, 0.25 * (x[0] + x[1] + x[2] + x[3])) ? 1 : 0;
    if (HasFailure()) return;
  }
  EXPECT_EQ(done, tried);
  EXPECT_EQ(editor_.counters().insertions, static_cast<std::uint64_t>(done));
}

// A limit on what is hidden refuses a point or leaves its cavity as it is without one.
TEST_P(SolidEditorFold, HiddenTetrahedraAreCountedWhileTheCavityGrows) {
  Random random(7);
  int found = 0, refused = 0;
  for (const TetId t : tets()) {
    std::array<double, 4> share{};
    double sum = 0;
    for (double& s : share) sum += s = 1e-3 + random.uniform();
    const auto x = editor_.points({t, 0});
    Point3 p;
    for (std::size_t i = 0; i < 4; ++i) p = p + (share[i] / sum) * x[i];
    const Location where{Kind::kInside, {t, 0}, 0, {}};
    Cavity any;
    ASSERT_TRUE(editor_.find_cavity(p, where, any));
    std::size_t smallest = 0;
    for (const std::size_t most : {0, 1, 4, 1000}) {
      Cavity limited;
      if (!editor_.find_cavity(p, where, limited, most)) {
        EXPECT_EQ(smallest, 0U) << "a larger limit refuses what a smaller one lets pass";
        ++refused;
        continue;
      }
      ++found;
      smallest = limited.tets.size();
      EXPECT_EQ(limited.tets, any.tets);
      EXPECT_EQ(limited.nearest2, any.nearest2);
    }
  }
  EXPECT_GT(found, 0);
  RecordProperty("refused", refused);
}

// In a frame that is not the stored one.
TEST_P(SolidEditorFold, InsertsInACopy) {
  const std::int32_t e = mesh().fold() - 1;
  int done = 0;
  for (const TetId t : tets()) {
    if (!mesh().alive(t)) continue;
    const auto x = editor_.points({t, e});
    done += insert({Kind::kInside, {t, e}, 0, {}}, 0.25 * (x[0] + x[1] + x[2] + x[3])) ? 1 : 0;
    if (HasFailure()) return;
  }
  EXPECT_GT(done, 0);
}

TEST_P(SolidEditorFold, InsertsOnSubfacets) {
  int hull = 0, internal = 0, tried = 0;
  for (const TetId t : tets()) {
    for (std::uint32_t i = 0; i < 4 && mesh().alive(t); ++i) {
      if (mesh().tet(t).facet[i] == kNoFacet) continue;
      const bool outside = mesh().tet(t).nb[i] == kNoHalfFace;
      Point3 p;
      for (const std::uint32_t k : kFaceCorners[i]) p = p + mesh().corner_point(t, k);
      ++tried;
      if (insert({Kind::kOnSubfacet, {t, 0}, i, {}}, (1.0 / 3) * p)) ++(outside ? hull : internal);
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(hull, 0);
  EXPECT_GT(internal, 0);
  EXPECT_EQ(hull + internal, tried);
}

TEST_P(SolidEditorFold, InsertsOnEdges) {
  int axis = 0, segments = 0, others = 0, tried = 0;
  for (const bool on_segments : {true, false}) {
    for (const TetId t : tets()) {
      for (const auto& e : kEdgeCorners) {
        if (!mesh().alive(t)) break;
        const OrbitVertex a = mesh().corner(t, e[0]), b = mesh().corner(t, e[1]);
        const bool segment = mesh().segment_of(a, b) != kNoSegment;
        if (segment != on_segments) continue;
        const bool on_axis = mesh().on_axis(a.orbit) && mesh().on_axis(b.orbit);
        ++tried;
        if (insert({Kind::kOnEdge, {t, 0}, 0, {a, b}}, 0.5 * (mesh().lift(a) + mesh().lift(b)))) {
          ++(on_axis ? axis : segment ? segments : others);
        }
        if (HasFailure()) return;
      }
    }
  }
  if (GetParam() > 1) {
    EXPECT_GT(axis, 0);
  }
  EXPECT_GT(segments, 0);
  EXPECT_GT(others, 0);
  EXPECT_GT(10 * (axis + segments + others), 9 * tried);
}

// The location says "inside" of a point in the middle of an edge or a face: the tetrahedra round it
// are found.
TEST_P(SolidEditorFold, InsertsOnAnEdgeTakenForInside) {
  int tried = 0, done = 0;
  for (const TetId t : tets()) {
    for (const auto& e : kEdgeCorners) {
      if (!mesh().alive(t)) break;
      const OrbitVertex a = mesh().corner(t, e[0]), b = mesh().corner(t, e[1]);
      if (!is_inner(t, a, b)) continue;
      ++tried;
      done += insert({Kind::kInside, {t, 0}, 0, {}}, 0.5 * (mesh().lift(a) + mesh().lift(b)));
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(tried, 0);
  EXPECT_GT(2 * done, tried);
}

TEST_P(SolidEditorFold, RefusesPointsAtVerticesAndOnUnnamedFacets) {
  for (const TetId t : tets()) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      EXPECT_FALSE(insert({Kind::kInside, {t, 0}, 0, {}}, mesh().corner_point(t, i)));
      if (mesh().tet(t).facet[i] == kNoFacet) continue;
      Point3 p;
      for (const std::uint32_t k : kFaceCorners[i]) p = p + mesh().corner_point(t, k);
      EXPECT_FALSE(insert({Kind::kInside, {t, 0}, 0, {}}, (1.0 / 3) * p));
    }
  }
}

NewTet again(const QuotientTetrahedralization& mesh, TetCopy c) {
  NewTet n;
  n.region = mesh.tet(c.t).region;
  for (std::uint32_t i = 0; i < 4; ++i) {
    n.c[i] = mesh.corner(c, i);
    n.facet[i] = mesh.tet(c.t).facet[i];
  }
  return n;
}

TEST_P(SolidEditorFold, ReplaceRefusesWhatDoesNotFit) {
  int outlines = 0, sides = 0;
  for (const TetId t : tets()) {
    const auto before = test::fingerprint(mesh());
    const std::array<TetCopy, 1> removed = {TetCopy{t, 0}};
    EXPECT_FALSE(editor_.replace(removed, {}));
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Tet& tet = mesh().tet(t);
      if (tet.facet[i] == kNoFacet) continue;
      NewTet n = again(mesh(), {t, 0});
      if (tet.nb[i] == kNoHalfFace) {
        // Another facet here: two facets have other outlines then.
        n.facet[i] = tet.facet[i] == 0 ? 1 : 0;
        EXPECT_FALSE(editor_.replace(removed, std::array{n}));
        ++outlines;
        continue;
      }
      const TetCopy behind = mesh().neighbour({t, 0}, i);
      if (behind.t == t) continue;
      const std::array<TetCopy, 2> both = {removed[0], behind};
      n.facet[i] = 0;
      EXPECT_FALSE(editor_.replace(both, std::array{n, again(mesh(), behind)}));
      ++sides;
    }
    EXPECT_EQ(before, test::fingerprint(mesh()));
  }
  EXPECT_GT(outlines, 0);
  EXPECT_GT(sides, 0);
  EXPECT_TRUE(test::is_valid(mesh(), volume_));
}

TEST_P(SolidEditorFold, WalksToThePointAndStopsAtSubfacets) {
  const auto all = tets();
  for (const TetId t : all) {
    for (const TetId goal : {all.front(), all[all.size() / 2], all.back()}) {
      const auto x = editor_.points({goal, 0});
      const Point3 p = 0.25 * (x[0] + x[1] + x[2] + x[3]);
      const auto walk = editor_.walk({t, 0}, p);
      ASSERT_FALSE(walk.lost);
      if (walk.blocked) {
        EXPECT_NE(mesh().tet(walk.at.t).facet[walk.face], kNoFacet);
      } else {
        EXPECT_EQ(walk.at, (TetCopy{goal, 0}));
      }
    }
    // Far outside: always blocked by the hull or before.
    EXPECT_TRUE(editor_.walk({t, 0}, {50, 40, 30}).blocked);
  }
}

}  // namespace
}  // namespace symcell::solid
