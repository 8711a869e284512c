// Every operation is done only where it betters what it changes, and leaves a mesh.
#include "core/solid/improve/surgery.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "core/solid/refine/refiner.hpp"
#include "tests/unit/core/solid/solid_checks.hpp"

namespace symcell::solid {
namespace {

constexpr int kMaxDone = 60;  // operations of a kind that a test looks at

class SolidSurgeryFold : public testing::TestWithParam<std::int32_t> {
 protected:
  struct Worth {
    double shape = 2;
    double excess = 0;
    double exempt = 0;  // of the ratio where it need not be kept
  };
  struct State {
    std::uint32_t version = 0;
    bool alive = false;
    Worth worth;
  };

  SolidSurgeryFold() {
    test::PrismShape s = test::prism_shape(GetParam());
    s.inner_facet = true;
    s.height = 2;
    solid_ = test::prism(s);
    volume_ = test::quotient_volume(mesh());
    options_.max_volume = volume_ / 150;
    {
      Editor editor(mesh());
      const Criteria criteria(solid_, options_);
      ExecutionContext context;
      EXPECT_TRUE(Refiner(editor, criteria, context).run());
    }
    test::random_flips(mesh(), 60, 5);
    test::jitter(mesh(), 0.25, 6);
    test::shuffle_gauge(mesh(), 7);
    options_.max_volume = volume_ / 60;
    options_.radius_edge = 3;  // most tetrahedra keep it
  }

  QuotientTetrahedralization& mesh() { return solid_.mesh; }

  std::vector<State> states(const Editor& editor,
                            const Surgery& surgery,
                            const Criteria& criteria) {
    std::vector<State> all(mesh().tet_slots());
    for (TetId t = 0; t < mesh().tet_slots(); ++t) {
      if (!mesh().alive(t)) continue;
      const Exemption exempt = criteria.exemption(mesh(), mesh().tet(t));
      all[t] = {
          mesh().tet(t).version,
          true,
          {surgery.shape(t), criteria.excess(editor.measures(t), mesh().tet(t).region, exempt),
           exempt != Exemption::kNone ? criteria.ratio_excess(editor.measures(t)) : 0}};
    }
    return all;
  }

  // Tries `operation` on every tetrahedron with each number below `ways`; checks each that is done.
  // `floor`, if given: all that the shape must keep.
  using Operation = std::function<bool(Surgery&, TetId, std::uint32_t)>;
  int run(std::uint32_t ways, const Operation& operation, double floor = -1) {
    Editor editor(mesh());
    const Criteria criteria(solid_, options_);
    Surgery surgery(editor, criteria);
    int done = 0;
    std::vector<State> before = states(editor, surgery, criteria);
    for (TetId t = 0; t < mesh().tet_slots() && done < kMaxDone; ++t) {
      for (std::uint32_t way = 0; way < ways && mesh().alive(t); ++way) {
        if (!operation(surgery, t, way)) continue;
        ++done;
        if (!test::is_valid(mesh(), volume_)) return done;
        const std::vector<State> after = states(editor, surgery, criteria);
        Worth old, now;
        for (std::size_t i = 0; i < after.size(); ++i) {
          const bool was = i < before.size() && before[i].alive;
          if (was && after[i].alive && before[i].version == after[i].version) continue;
          if (was) {
            old.shape = std::min(old.shape, before[i].worth.shape);
            old.excess = std::max(old.excess, before[i].worth.excess);
            old.exempt = std::max(old.exempt, before[i].worth.exempt);
          }
          if (!after[i].alive) continue;
          now.shape = std::min(now.shape, after[i].worth.shape);
          now.excess = std::max(now.excess, after[i].worth.excess);
          now.exempt = std::max(now.exempt, after[i].worth.exempt);
          // What the surgery keeps is so.
          const auto x = editor.points({static_cast<TetId>(i), 0});
          EXPECT_EQ(after[i].worth.shape, min_dihedral_sine(x[0], x[1], x[2], x[3]));
          EXPECT_TRUE(std::find(surgery.touched().begin(), surgery.touched().end(), i) !=
                      surgery.touched().end());
        }
        EXPECT_LE(now.excess, std::max(1.0, old.excess));
        if (floor >= 0) {
          EXPECT_GE(now.shape, std::min(floor, old.shape));
        } else if (old.excess <= 1 && old.exempt <= 1) {
          EXPECT_GT(now.shape, old.shape);
          EXPECT_LE(now.exempt, 1);
        } else if (old.excess <= 1) {
          EXPECT_TRUE(now.exempt < old.exempt || now.shape > old.shape);
        } else {
          EXPECT_TRUE(now.excess < old.excess || now.shape > old.shape);
        }
        if (HasFailure()) return done;
        before = after;
        break;
      }
    }
    return done;
  }

  // What lies at an edge.
  enum class EdgePlace { kFree, kHull, kInternalFacet };
  EdgePlace place(TetId t, std::uint32_t i, std::uint32_t j) {
    const OrbitVertex a = mesh().corner(t, i), b = mesh().corner(t, j);
    std::vector<TetCopy> ring;
    const bool closed = mesh().ring({t, 0}, a, b, ring);
    if (!closed) return EdgePlace::kHull;
    for (const TetCopy& c : ring) {
      for (std::uint32_t f = 0; f < 4; ++f) {
        const OrbitVertex x = mesh().corner(c, f);
        if (x != a && x != b && mesh().tet(c.t).facet[f] != kNoFacet) {
          return EdgePlace::kInternalFacet;
        }
      }
    }
    return EdgePlace::kFree;
  }

  InitialTetrahedralization solid_;
  MeshOptions options_;
  int facet_flips_[2] = {0, 0};  // at the hull, at an internal facet
  double volume_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Folds, SolidSurgeryFold, testing::Values(1, 2, 3, 6, 12));

TEST_P(SolidSurgeryFold, RemovesEdges) {
  int inside = 0, hull = 0;
  const int done = run(6, [&](Surgery& s, TetId t, std::uint32_t e) {
    const auto& c = kEdgeCorners[e];
    const EdgePlace p = place(t, c[0], c[1]);
    const bool segment =
        mesh().segment_of(mesh().corner(t, c[0]), mesh().corner(t, c[1])) != kNoSegment;
    if (!s.remove_edge(t, c[0], c[1])) return false;
    EXPECT_FALSE(segment);
    ++(p == EdgePlace::kFree ? inside : hull);
    return true;
  });
  EXPECT_GT(done, 0);
  EXPECT_GT(inside, 0);
}

TEST_P(SolidSurgeryFold, RemovesEdgesOfFacets) {
  // Points of facets moved within them, so that other diagonals are better.
  for (std::size_t i = 0; i < mesh().vertex_slots(); ++i) {
    const auto v = static_cast<VertexId>(i);
    if (mesh().kind(v) != VertexKind::kFacet || mesh().parent(v) > 1) continue;
    const Point3 p = mesh().point(v);
    // As far as it goes, in directions that differ.
    const double angle = 2.4 * static_cast<double>(i);
    for (const double step : {0.5, 0.35, 0.25, 0.15, 0.08, 0.0}) {
      mesh().move_vertex(v, {p.x + step * std::cos(angle), p.y + step * std::sin(angle), p.z});
      if (validate(mesh(), ValidationLevel::kEmbedding, volume_)) break;
    }
  }
  for (const EdgePlace wanted : {EdgePlace::kHull, EdgePlace::kInternalFacet}) {
    static_cast<void>(run(6, [&](Surgery& s, TetId t, std::uint32_t e) {
      const auto& c = kEdgeCorners[e];
      if (place(t, c[0], c[1]) != wanted) return false;
      if (!s.remove_edge(t, c[0], c[1])) return false;
      ++facet_flips_[wanted == EdgePlace::kHull ? 0 : 1];
      return true;
    }));
  }
  EXPECT_GT(facet_flips_[0], 0);
  if (GetParam() == 1 || GetParam() >= 6) {
    EXPECT_GT(facet_flips_[1], 0);
  }
}

// Two flat tetrahedra at a large face are better as three round the line between their tops, two
// tall ones are not.
TEST(SolidSurgery, RemovesAFaceWhereThatIsBetter) {
  for (const double height : {0.2, 1.5}) {
    InitialTetrahedralization solid;
    QuotientTetrahedralization& mesh = solid.mesh;
    for (const Point3& p : {Point3{1, 0, 0}, Point3{-0.5, 0.8, 0}, Point3{-0.5, -0.8, 0},
                            Point3{0, 0, height}, Point3{0, 0, -height}}) {
      mesh.add_vertex(p, VertexKind::kInput, false);
    }
    std::array<NewTet, 2> tets;
    const VertexId corners[2][4] = {{0, 1, 2, 3}, {0, 2, 1, 4}};
    for (std::size_t t = 0; t < 2; ++t) {
      for (std::size_t i = 0; i < 4; ++i) tets[t].c[i] = {corners[t][i], 0};
      for (std::size_t i = 0; i < 3; ++i) tets[t].facet[i] = static_cast<std::int32_t>(3 * t + i);
    }
    ASSERT_TRUE(mesh.build(tets));
    std::int32_t segment = 0;
    for (VertexId a = 0; a < 3; ++a) {
      for (const VertexId b : {(a + 1) % 3, 3, 4}) {
        mesh.set_segment(mesh.edge_key({a, 0}, {b, 0}), segment++);
      }
    }
    solid.subdomains = {{0, kInfinity}};
    const double volume = test::quotient_volume(mesh);
    ASSERT_TRUE(test::is_valid(mesh, volume));
    Editor editor(mesh);
    const Criteria criteria(solid, {});
    Surgery surgery(editor, criteria);
    const auto worst = [&] {
      double least = 2;
      for (TetId t = 0; t < mesh.tet_slots(); ++t) {
        if (mesh.alive(t)) least = std::min(least, surgery.shape(t));
      }
      return least;
    };
    const double before = worst();
    for (std::uint32_t i = 0; i < 3; ++i) EXPECT_FALSE(surgery.remove_face(0, i));
    EXPECT_EQ(surgery.remove_face(0, 3), height < 1);
    EXPECT_EQ(mesh.tet_count(), height < 1 ? 3U : 2U);
    EXPECT_EQ(worst() > before, height < 1);
    EXPECT_TRUE(test::is_valid(mesh, volume));
  }
}

TEST_P(SolidSurgeryFold, MovesVerticesWhereTheyBelong) {
  int free = 0, facet = 0, segment = 0;
  static_cast<void>(run(4, [&](Surgery& s, TetId t, std::uint32_t i) {
    const VertexId v = mesh().tet(t).v[i];
    const VertexKind kind = mesh().kind(v);
    const Point3 from = mesh().point(v);
    if (!s.smooth(v)) return false;
    const Point3 to = mesh().point(v);
    EXPECT_NE(kind, VertexKind::kInput);
    if (kind == VertexKind::kFree) ++free;
    if (kind == VertexKind::kFacet) {
      ++facet;
      // Bottom, top and plate are level.
      const bool plate =
          mesh().parent(v) == static_cast<std::int32_t>(solid_.facet_markers.size()) - 1;
      if (mesh().parent(v) < 2 || plate) {
        EXPECT_NEAR(to.z, from.z, 1e-14);
      }
    }
    if (kind == VertexKind::kSegment) {
      ++segment;
      if (mesh().on_axis(v)) {
        EXPECT_EQ(to.x, 0);
        EXPECT_EQ(to.y, 0);
      } else if (to.z != from.z) {  // an upright edge
        EXPECT_NEAR(to.x, from.x, 1e-13);
        EXPECT_NEAR(to.y, from.y, 1e-13);
      }
    }
    return true;
  }));
  EXPECT_GT(free + facet + segment, 0);
  EXPECT_GT(facet + segment, 0);
}

// Poor tetrahedra after random flips, for each of which the worst of what is replaced gets better.
TEST_P(SolidSurgeryFold, InsertsVertices) {
  std::size_t vertices = 0;
  const auto live = [&] {
    std::size_t count = 0;
    for (std::size_t v = 0; v < mesh().vertex_slots(); ++v) {
      count += mesh().kind(static_cast<VertexId>(v)) != VertexKind::kDeleted ? 1 : 0;
    }
    return count;
  };
  const std::size_t segments = mesh().edges().size(), before = live();
  const int done = run(1, [&](Surgery& s, TetId t, std::uint32_t) {
    if (s.shape(t) > 0.3 || !s.insert_point(t)) return false;
    ++vertices;
    return true;
  });
  EXPECT_GT(done, 0);
  EXPECT_EQ(live(), before + vertices);
  EXPECT_EQ(mesh().edges().size(), segments);
}

TEST_P(SolidSurgeryFold, MergesVertices) {
  constexpr double kFloor = 0.05;
  options_.max_volume = volume_ / 10;
  int in_place = 0, half_way = 0, free = 0, facet = 0, segment = 0;
  const std::size_t segments = mesh().edges().size();
  const int done = run(
      12,
      [&](Surgery& s, TetId t, std::uint32_t way) {
        const std::uint32_t from = way % 4, to = (from + 1 + way / 4) % 4;
        const VertexId goes = mesh().tet(t).v[from], stays = mesh().tet(t).v[to];
        const VertexKind kind = mesh().kind(goes);
        const Point3 at = mesh().point(stays);
        if (!s.collapse(t, from, to, kFloor)) return false;
        EXPECT_NE(kind, VertexKind::kInput);
        EXPECT_EQ(mesh().kind(goes), VertexKind::kDeleted);
        ++(mesh().point(stays) == at ? in_place : half_way);
        free += kind == VertexKind::kFree;
        facet += kind == VertexKind::kFacet;
        segment += kind == VertexKind::kSegment;
        return true;
      },
      kFloor);
  EXPECT_GT(done, 0);
  EXPECT_GT(in_place, 0);
  EXPECT_GT(half_way, 0);
  EXPECT_GT(facet, 0);
  EXPECT_GT(segment, 0);
  if (GetParam() > 1) {
    EXPECT_GT(free, 0);
  }
  EXPECT_EQ(mesh().edges().size(), segments - static_cast<std::size_t>(segment));
}

// Whatever a trial does, lenient or not, it can be taken back, slot by slot; and a mesh that was
// never tried on goes on alike.
TEST_P(SolidSurgeryFold, TrialsAreTakenBack) {
  const InitialTetrahedralization untouched = solid_;
  Editor editor(mesh());
  const Criteria criteria(solid_, options_);
  Surgery surgery(editor, criteria);
  std::vector<double> shapes;
  for (TetId t = 0; t < mesh().tet_slots(); ++t) {
    shapes.push_back(mesh().alive(t) ? surgery.shape(t) : 0);
  }
  const auto before = test::fingerprint(mesh());
  int edits = 0;
  for (TetId t = 0; t < untouched.mesh.tet_slots() && edits < 4 * kMaxDone; ++t) {
    if (!mesh().alive(t)) continue;
    surgery.begin();
    for (const bool lenient : {true, false}) {
      surgery.set_lenient(lenient);
      for (std::uint32_t way = 0; way < 12 && mesh().alive(t); ++way) {
        const std::uint32_t i = way % 4, j = (i + 1 + way / 4) % 4;
        edits += surgery.collapse(t, i, j, 0.1) ? 1 : 0;
        if (mesh().alive(t)) edits += surgery.remove_edge(t, i, j) ? 1 : 0;
        if (mesh().alive(t)) edits += surgery.remove_face(t, i) ? 1 : 0;
        if (mesh().alive(t)) edits += surgery.smooth(mesh().tet(t).v[i]) ? 1 : 0;
        if (mesh().alive(t)) edits += surgery.insert_point(t) ? 1 : 0;
      }
    }
    ASSERT_TRUE(test::is_valid(mesh(), volume_));
    surgery.roll_back();
    ASSERT_EQ(test::fingerprint(mesh()), before);
  }
  EXPECT_GT(edits, kMaxDone);
  EXPECT_EQ(mesh().tet_count(), untouched.mesh.tet_count());
  untouched.mesh.edges().for_each([&](const EdgeKey& key, std::int32_t segment) {
    EXPECT_EQ(mesh().edges().find(key), segment);
  });
  for (TetId t = 0; t < mesh().tet_slots(); ++t) {
    if (!mesh().alive(t)) continue;
    EXPECT_EQ(surgery.shape(t), shapes[t]);
    EXPECT_EQ(editor.measures(t).volume, editor.measure(t).volume);
  }
  InitialTetrahedralization other = untouched;
  Editor other_editor(other.mesh);
  Surgery other_surgery(other_editor, criteria);
  surgery.set_lenient(false);
  for (TetId t = 0; t < 200 && t < mesh().tet_slots(); ++t) {
    if (!mesh().alive(t)) continue;
    ASSERT_EQ(surgery.remove_edge(t, 0, 1), other_surgery.remove_edge(t, 0, 1));
  }
  EXPECT_EQ(test::fingerprint(mesh()), test::fingerprint(other.mesh));
}

}  // namespace
}  // namespace symcell::solid
