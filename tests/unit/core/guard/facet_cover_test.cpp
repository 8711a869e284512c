// What subfacets and subsegments cover: unchanged by whatever an editor does, changed by any
// damage.
#include "core/guard/facet_cover.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/solid/quotient/constraints.hpp"
#include "tests/unit/core/solid/solid_checks.hpp"

namespace symcell {
namespace {

constexpr double kDiameter = 4.2;
constexpr std::int32_t kAxisSegment = 0;  // of the samples

struct Case {
  std::int32_t fold;
  bool bore;
};

std::string name_of(const testing::TestParamInfo<Case>& info) {
  return "Fold" + std::to_string(info.param.fold) + (info.param.bore ? "Bore" : "");
}

class FacetCoverSample : public testing::TestWithParam<Case> {
 protected:
  FacetCoverSample() : solid_(test::prism(shape())), editor_(solid_.mesh) {
    test::shuffle_gauge(solid_.mesh, 5);
    given_ = list();
    auto cover = measure_facet_cover(given_);
    EXPECT_TRUE(cover) << cover.error().message;
    cover_ = cover.value_or(FacetCover{});
  }

  static test::PrismShape shape() {
    test::PrismShape s = solid::test::prism_shape(GetParam().fold, GetParam().bore ? 0.7 : 0);
    s.inner_facet = true;
    s.swirl = 0.1;
    return s;
  }
  [[nodiscard]] Constraints list() const {
    return solid::constraints_of(solid_.mesh, kAxisSegment);
  }
  solid::QuotientTetrahedralization& mesh() { return solid_.mesh; }

  // What is wrong with the lists; empty: nothing.
  [[nodiscard]] std::string fault(const Constraints& lists) const {
    const auto found = measure_facet_cover(lists);
    if (!found) return found.error().message;
    const auto same = compare_facet_covers(cover_, *found, kDiameter);
    return same ? "" : same.error().message;
  }
  void expect_covered() { EXPECT_EQ(fault(list()), ""); }
  // Damages one subfacet after the other, each in a copy of the lists.
  void expect_each_found(const std::function<void(Constraints&, std::size_t)>& damage) {
    for (std::size_t i = 0; i < given_.subfacets.size(); ++i) {
      Constraints damaged = given_;
      damage(damaged, i);
      EXPECT_NE(fault(damaged), "") << "subfacet " << i;
    }
  }
  [[nodiscard]] std::vector<std::int32_t> vertices(solid::VertexKind kind) const {
    std::vector<std::int32_t> result;
    for (std::size_t v = 0; v < given_.points.size(); ++v) {
      const auto id = static_cast<VertexId>(v);
      if (solid_.mesh.kind(id) == kind && !solid_.mesh.on_axis(id)) result.push_back(id);
    }
    return result;
  }

  solid::InitialTetrahedralization solid_;
  solid::Editor editor_;
  Constraints given_;
  FacetCover cover_;
};

INSTANTIATE_TEST_SUITE_P(Samples,
                         FacetCoverSample,
                         testing::Values(Case{1, false},
                                         Case{1, true},
                                         Case{2, false},
                                         Case{2, true},
                                         Case{3, false},
                                         Case{3, true},
                                         Case{6, false},
                                         Case{6, true},
                                         Case{12, false},
                                         Case{12, true}),
                         name_of);

TEST_P(FacetCoverSample, TellsWhatIsThere) {
  expect_covered();
  // A plate across, which is no boundary.
  EXPECT_EQ(cover_.boundary.shells, 1);
  EXPECT_EQ(cover_.boundary.euler, GetParam().bore ? 0 : 2);
  EXPECT_EQ(cover_.boundary.open_edges, 0U);
  const FacetCover::Facet &bottom = cover_.facets[0], &plate = cover_.facets.back();
  const double area = test::prism_volume(shape()) / shape().fold / shape().height;
  EXPECT_NEAR(bottom.one_sided_area, area, 1e-12);
  EXPECT_EQ(bottom.two_sided_area, 0);
  EXPECT_NEAR(plate.two_sided_area, area, 1e-12);
  EXPECT_EQ(plate.one_sided_area, 0);
  EXPECT_LT(plate.bend, 1e-15);
}

TEST_P(FacetCoverSample, TheGaugeChangesNothing) {
  for (const std::uint64_t seed : {11U, 12U}) {
    test::shuffle_gauge(mesh(), seed);
    expect_covered();
  }
}

TEST_P(FacetCoverSample, LegalEditsChangeNothing) {
  int facets = 0, edges = 0, inside = 0;
  for (const solid::TetId t : solid::test::live_tets(mesh())) {
    for (std::uint32_t f = 0; f < 4 && mesh().alive(t); ++f) {
      if (mesh().tet(t).facet[f] == solid::kNoFacet) continue;
      const auto [where, p] = solid::test::middle_of_face(mesh(), t, f);
      facets += solid::test::insert_point(editor_, where, p) != solid::Editor::kNoVertex ? 1 : 0;
      expect_covered();
    }
  }
  for (const solid::TetId t : solid::test::live_tets(mesh())) {
    for (std::size_t e = 0; e < 6 && mesh().alive(t); e += 2) {
      const auto [where, p] = solid::test::middle_of_edge(mesh(), t, e);
      edges += solid::test::insert_point(editor_, where, p) != solid::Editor::kNoVertex ? 1 : 0;
    }
    if (HasFailure()) return;
  }
  expect_covered();
  for (const solid::TetId t : solid::test::live_tets(mesh())) {
    if (!mesh().alive(t)) continue;
    const auto x = editor_.points({t, 0});
    const Point3 p = 0.25 * (x[0] + x[1] + x[2] + x[3]);
    const solid::Location where{solid::Location::Kind::kInside, {t, 0}, 0, {}};
    inside += solid::test::insert_point(editor_, where, p) != solid::Editor::kNoVertex ? 1 : 0;
  }
  test::random_flips(mesh(), 200, 7);
  expect_covered();
  EXPECT_GT(facets, 10);
  EXPECT_GT(edges, 20);
  EXPECT_GT(inside, 20);
}

TEST_P(FacetCoverSample, FindsASubfacetThatIsGone) {
  expect_each_found([](Constraints& c, std::size_t i) {
    c.subfacets.erase(c.subfacets.begin() + static_cast<std::ptrdiff_t>(i));
  });
}

TEST_P(FacetCoverSample, FindsASubfacetThatIsThereTwice) {
  expect_each_found(
      [](Constraints& c, std::size_t i) { c.subfacets.push_back(Subfacet(c.subfacets[i])); });
  // Turned round it cancels in the boundary.
  expect_each_found([](Constraints& c, std::size_t i) {
    Subfacet again = c.subfacets[i];
    std::swap(again.corners[0], again.corners[1]);
    c.subfacets.push_back(again);
  });
}

TEST_P(FacetCoverSample, FindsASubfacetOfAnotherFacet) {
  for (std::int32_t other = 0; other <= 1 + given_.subfacets.back().facet; ++other) {
    expect_each_found([&](Constraints& c, std::size_t i) {
      // A side of a sector of one step is a facet of its own, and adjoins its next copy.
      c.subfacets[i].facet = c.subfacets[i].facet == other ? other + 1 : other;
    });
  }
}

TEST_P(FacetCoverSample, FindsAWholeFacetThatIsGone) {
  for (std::size_t f = 0; f < cover_.facets.size(); ++f) {
    Constraints damaged = given_;
    std::erase_if(damaged.subfacets, [&](const Subfacet& s) { return at(s.facet) == f; });
    EXPECT_NE(fault(damaged), "") << "facet " << f;
  }
}

TEST_P(FacetCoverSample, FindsASubfacetAcrossAGap) {
  // One corner somewhere else in the facet.
  for (const std::int32_t step : {1, 2, 3}) {
    expect_each_found([&](Constraints& c, std::size_t i) {
      Subfacet& s = c.subfacets[i];
      std::vector<std::int32_t> others;
      for (const Subfacet& t : given_.subfacets) {
        for (const OrbitVertex& v : t.corners) {
          if (t.facet == s.facet && v.orbit != s.corners[0].orbit) others.push_back(v.orbit);
        }
      }
      const std::int32_t v = others[(i * 7 + at(step)) % others.size()];
      s.corners[0] = {v, c.on_axis[at(v)] != 0 ? 0 : step % c.fold};
    });
  }
}

TEST_P(FacetCoverSample, FindsAFold) {
  // A vertex moved out of its star within the plane.
  for (const std::int32_t v : vertices(solid::VertexKind::kFacet)) {
    Constraints damaged = given_;
    Point3& p = damaged.points[at(v)];
    p = {3 * p.x + 5, 3 * p.y, p.z};
    EXPECT_NE(fault(damaged).find("folds"), std::string::npos);
  }
}

TEST_P(FacetCoverSample, FindsAVertexOffItsPlane) {
  for (const std::int32_t v : vertices(solid::VertexKind::kFacet)) {
    for (const double way : {1e-3, -1e-3, 1e-4}) {
      Constraints damaged = given_;
      damaged.points[at(v)].z += way;
      EXPECT_NE(fault(damaged), "") << "vertex " << v << " off by " << way;
    }
    // Within the plane it may move, and by what facets are flat to.
    Constraints moved = given_;
    moved.points[at(v)].x += 1e-3;
    moved.points[at(v)].z += 1e-8 * kDiameter;
    EXPECT_EQ(fault(moved), "");
  }
}

TEST_P(FacetCoverSample, FindsASubsegmentThatIsGoneOrElsewhere) {
  for (std::size_t i = 0; i < given_.subsegments.size(); ++i) {
    Constraints damaged = given_;
    damaged.subsegments.erase(damaged.subsegments.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(fault(damaged), "") << "subsegment " << i;
    damaged = given_;
    ++damaged.subsegments[i].segment;
    EXPECT_NE(fault(damaged), "") << "subsegment " << i;
    damaged = given_;
    damaged.subsegments.push_back(damaged.subsegments[i]);
    ++damaged.subsegments.back().segment;
    EXPECT_NE(fault(damaged), "") << "subsegment " << i;
  }
  // The same one as another copy is one.
  Constraints copied = given_;
  Subsegment3 copy = given_.subsegments.front();
  for (OrbitVertex* v : {&copy.a, &copy.b}) {
    if (given_.on_axis[at(v->orbit)] == 0) v->exponent = (v->exponent + 1) % given_.fold;
  }
  copied.subsegments.push_back(copy);
  EXPECT_EQ(fault(copied), "");
}

TEST_P(FacetCoverSample, FindsAVertexOffItsSegment) {
  const auto on_segments = vertices(solid::VertexKind::kSegment);
  for (const std::int32_t v : on_segments) {
    Constraints damaged = given_;
    damaged.points[at(v)].x += 1e-3;
    damaged.points[at(v)].y += 1e-3;
    EXPECT_NE(fault(damaged), "");
  }
  for (const std::int32_t v : vertices(solid::VertexKind::kInput)) {
    Constraints damaged = given_;
    Point3& p = damaged.points[at(v)];
    p = {(1 - 1e-6) * p.x, (1 - 1e-6) * p.y, p.z};
    EXPECT_NE(fault(damaged).find("segment"), std::string::npos);
  }
}

TEST_P(FacetCoverSample, FindsTheSolidOnAnotherNumberOfSides) {
  expect_each_found(
      [](Constraints& c, std::size_t i) { c.subfacets[i].two_sided = !c.subfacets[i].two_sided; });
  for (std::size_t f = 0; f < cover_.facets.size(); ++f) {
    Constraints damaged = given_;
    for (Subfacet& s : damaged.subfacets) {
      if (at(s.facet) == f) s.two_sided = !s.two_sided;
    }
    EXPECT_NE(fault(damaged), "") << "facet " << f;
  }
}

TEST_P(FacetCoverSample, FindsABoundaryTurnedInsideOut) {
  expect_each_found([&](Constraints& c, std::size_t i) {
    Subfacet& s = c.subfacets[i];
    std::swap(s.corners[0], s.corners[1]);
    if (s.two_sided) s.facet = 0;  // may be seen from either side
  });
}

}  // namespace
}  // namespace symcell
