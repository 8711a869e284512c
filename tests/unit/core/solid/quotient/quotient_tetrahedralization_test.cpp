#include "core/solid/quotient/quotient_tetrahedralization.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "core/solid/quotient/validate.hpp"
#include "tests/support/solid_samples.hpp"

namespace symcell::solid {
namespace {

using test::PrismShape;

std::vector<PrismShape> shapes() {
  std::vector<PrismShape> result;
  for (const std::int32_t fold : {1, 2, 3, 4, 7, 24}) {
    for (const double inner : {0.0, 1.2}) {
      PrismShape s;
      s.fold = fold;
      s.steps = fold == 1 ? 5 : fold == 2 ? 2 : 1;
      s.inner_radius = inner;
      result.push_back(s);
      s.rings = 3;
      s.layers = 2;
      s.inner_facet = inner == 0;
      result.push_back(s);
      s.steps += 1;
      s.swirl = 0.4 / (fold * s.steps);
      s.layers = 4;
      result.push_back(s);
    }
  }
  return result;
}

std::string name(const PrismShape& s) {
  return "fold " + std::to_string(s.fold) + ", steps " + std::to_string(s.steps) + ", rings " +
         std::to_string(s.rings) + ", layers " + std::to_string(s.layers) +
         (s.inner_radius > 0 ? ", ring" : ", axis");
}

void expect_valid(const QuotientTetrahedralization& mesh, const PrismShape& s) {
  const auto report = validate(mesh, ValidationLevel::kDelaunay, test::prism_volume(s) / s.fold);
  ASSERT_TRUE(report) << name(s) << ": " << report.error().message;
}

// Tetrahedra as sets of corners in the frame where the smallest set results: what meshes with other
// slots and gauges have in common.
using Name = std::array<std::pair<VertexId, std::int32_t>, 4>;

std::multiset<Name> names(const QuotientTetrahedralization& mesh) {
  std::multiset<Name> result;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    Name best{};
    for (std::uint32_t ref = 0; ref < 4; ++ref) {
      const OrbitVertex r = mesh.corner(t, ref);
      if (mesh.on_axis(r.orbit)) continue;
      Name n;
      for (std::uint32_t i = 0; i < 4; ++i) {
        const OrbitVertex c = mesh.corner(TetCopy{t, mesh.subtract(0, r.exponent)}, i);
        n[i] = {c.orbit, c.exponent};
      }
      std::sort(n.begin(), n.end());
      if (best == Name{} || n < best) best = n;
    }
    result.insert(best);
  }
  return result;
}

std::vector<std::pair<TetId, std::int32_t>> sorted(const std::vector<TetCopy>& copies) {
  std::vector<std::pair<TetId, std::int32_t>> result;
  for (const TetCopy& c : copies) result.emplace_back(c.t, c.e);
  std::sort(result.begin(), result.end());
  return result;
}

// All copies (t, e) that have every one of the corners; on the axis e = 0 stands for all.
std::vector<std::pair<TetId, std::int32_t>> copies_with(const QuotientTetrahedralization& mesh,
                                                        const std::vector<OrbitVertex>& corners) {
  const bool axis = std::all_of(corners.begin(), corners.end(),
                                [&](OrbitVertex c) { return mesh.on_axis(c.orbit); });
  std::vector<std::pair<TetId, std::int32_t>> result;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    for (std::int32_t e = 0; e < (axis ? 1 : mesh.fold()); ++e) {
      const bool has = std::all_of(corners.begin(), corners.end(), [&](OrbitVertex c) {
        for (std::uint32_t i = 0; i < 4; ++i) {
          if (mesh.corner(TetCopy{t, e}, i) == c) return true;
        }
        return false;
      });
      if (has) result.emplace_back(t, e);
    }
  }
  return result;
}

TEST(QuotientTetrahedralization, BuildsValidMeshes) {
  for (const PrismShape& s : shapes()) expect_valid(test::prism(s).mesh, s);
}

TEST(QuotientTetrahedralization, GaugeIsOfNoImportance) {
  for (const PrismShape& s : shapes()) {
    auto solid = test::prism(s);
    const auto before = names(solid.mesh);
    test::shuffle_gauge(solid.mesh, 3);
    expect_valid(solid.mesh, s);
    EXPECT_EQ(names(solid.mesh), before);
  }
}

TEST(QuotientTetrahedralization, StarsAreWholeAndHoldNothingTwice) {
  for (const PrismShape& s : shapes()) {
    auto solid = test::prism(s);
    test::shuffle_gauge(solid.mesh, 5);
    std::vector<TetCopy> star;
    for (std::size_t v = 0; v < solid.mesh.vertex_slots(); ++v) {
      star.clear();
      solid.mesh.star(static_cast<VertexId>(v), star);
      ASSERT_EQ(sorted(star), copies_with(solid.mesh, {{static_cast<VertexId>(v), 0}})) << name(s);
    }
  }
}

TEST(QuotientTetrahedralization, RingsAreWholeAndInOrder) {
  for (const PrismShape& s : shapes()) {
    auto solid = test::prism(s);
    QuotientTetrahedralization& mesh = solid.mesh;
    test::shuffle_gauge(mesh, 7);
    std::vector<TetCopy> ring;
    for (TetId t = 0; t < mesh.tet_slots(); ++t) {
      for (const auto& e : kEdgeCorners) {
        const OrbitVertex a = mesh.corner(t, e[0]), b = mesh.corner(t, e[1]);
        ring.clear();
        const bool closed = mesh.ring({t, 0}, a, b, ring);
        const bool axis = mesh.on_axis(a.orbit) && mesh.on_axis(b.orbit);
        std::vector<TetCopy> folded = ring;
        for (TetCopy& c : folded) c.e = axis ? 0 : c.e;
        ASSERT_EQ(sorted(folded), copies_with(mesh, {a, b})) << name(s);
        // Neighbours in the row are neighbours across a face with the edge.
        for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
          bool adjacent = false;
          for (std::uint32_t f = 0; f < 4; ++f) {
            adjacent = adjacent || (mesh.tet(ring[i].t).nb[f] != kNoHalfFace &&
                                    mesh.neighbour(ring[i], f) == ring[i + 1]);
          }
          ASSERT_TRUE(adjacent) << name(s);
        }
        int open = 0;
        for (const TetCopy& c : ring) {
          for (std::uint32_t f = 0; f < 4; ++f) {
            const OrbitVertex x = mesh.corner(c, f);
            if (!(x == a) && !(x == b) && mesh.tet(c.t).nb[f] == kNoHalfFace) ++open;
          }
        }
        ASSERT_EQ(open, closed ? 0 : 2) << name(s);
      }
    }
  }
}

TEST(QuotientTetrahedralization, RandomFlipsKeepTheMeshValid) {
  int done = 0;
  for (const PrismShape& s : shapes()) {
    auto solid = test::prism(s);
    test::shuffle_gauge(solid.mesh, 9);
    for (int round = 0; round < 10; ++round) {
      done += test::random_flips(solid.mesh, 40, static_cast<std::uint64_t>(round));
      expect_valid(solid.mesh, s);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(done, 300);
}

// Splits a tetrahedron at its centroid, and merges the four again.
TEST(QuotientTetrahedralization, ReplaceUndoesASplit) {
  for (const PrismShape& s : shapes()) {
    auto solid = test::prism(s);
    QuotientTetrahedralization& mesh = solid.mesh;
    test::shuffle_gauge(mesh, 11);
    const auto before = names(mesh);
    for (TetId t = 0; t < before.size(); t += 3) {
      if (!mesh.alive(t)) continue;
      const Tet old = mesh.tet(t);
      // In another frame, as a cavity would have it.
      const TetCopy copy{t, mesh.fold() / 2};
      Point3 middle{};
      for (std::uint32_t i = 0; i < 4; ++i) middle = middle + 0.25 * mesh.corner_point(t, i);
      const std::int32_t exponent = 1 % mesh.fold();
      const Point3 p = mesh.rotations().rotate(
          middle, mesh.rotations().reduce(static_cast<std::int64_t>(copy.e) - exponent));
      const VertexId v = mesh.add_vertex(p, VertexKind::kFree, false);
      std::vector<NewTet> split(4);
      NewTet whole;
      for (std::uint32_t i = 0; i < 4; ++i) {
        whole.c[i] = mesh.corner(copy, i);
        split[i].region = whole.region = old.region;
        for (std::uint32_t j = 0; j < 4; ++j) split[i].c[j] = mesh.corner(copy, j);
        split[i].c[i] = {v, exponent};
      }
      ASSERT_TRUE(mesh.replace(std::array{copy}, split)) << name(s) << " tet " << t;
      ASSERT_EQ(mesh.added_ids().size(), 4U);
      expect_valid(mesh, s);
      if (HasFatalFailure()) return;
      std::vector<TetCopy> star;
      mesh.star(v, star);
      ASSERT_EQ(star.size(), 4U);
      for (TetCopy& c : star) c.e = mesh.add(c.e, exponent);
      ASSERT_TRUE(mesh.replace(star, std::array{whole}));
      mesh.release_vertex(v);
      expect_valid(mesh, s);
      if (HasFatalFailure()) return;
    }
    EXPECT_EQ(names(mesh), before) << name(s);
  }
}

TEST(QuotientTetrahedralization, ReplaceRefusesWhatDoesNotFit) {
  PrismShape s;
  s.rings = 2;
  auto solid = test::prism(s);
  QuotientTetrahedralization& mesh = solid.mesh;
  const auto before = names(mesh);
  NewTet same;
  for (std::uint32_t i = 0; i < 4; ++i) same.c[i] = mesh.corner(0, i);
  NewTet other = same;
  other.c[0] = mesh.corner(5, 0);
  other.c[1] = mesh.corner(5, 1);
  EXPECT_FALSE(mesh.replace(std::array{TetCopy{0, 0}}, std::array{other}));
  EXPECT_FALSE(mesh.replace(std::array{TetCopy{0, 0}, TetCopy{0, 1}}, std::array{same}));
  EXPECT_FALSE(mesh.replace(std::array{TetCopy{0, 0}}, std::array{same, same}));
  EXPECT_FALSE(mesh.replace(std::array{TetCopy{0, 0}, TetCopy{1, 0}}, std::array{same}));
  EXPECT_FALSE(mesh.replace(std::array{TetCopy{0, 0}}, std::span<const NewTet>{}));
  EXPECT_EQ(names(mesh), before);
  expect_valid(mesh, s);
  EXPECT_TRUE(mesh.replace(std::array{TetCopy{0, 0}}, std::array{same}));
  expect_valid(mesh, s);
  EXPECT_EQ(names(mesh), before);
}

TEST(QuotientTetrahedralization, CompactKeepsEverything) {
  for (const PrismShape& s : shapes()) {
    auto solid = test::prism(s);
    QuotientTetrahedralization& mesh = solid.mesh;
    test::random_flips(mesh, 200, 13);
    const QuotientTetrahedralization before = mesh;
    const std::vector<VertexId> place = mesh.compact();
    EXPECT_EQ(mesh.tet_slots(), mesh.tet_count());
    EXPECT_EQ(mesh.tet_count(), before.tet_count());
    EXPECT_EQ(mesh.edges().size(), before.edges().size());
    expect_valid(mesh, s);
    for (std::size_t v = 0; v < place.size(); ++v) {
      const auto old = static_cast<VertexId>(v);
      ASSERT_GE(place[v], 0);
      EXPECT_EQ(mesh.point(place[v]), before.point(old));
      EXPECT_EQ(mesh.kind(place[v]), before.kind(old));
      EXPECT_EQ(mesh.parent(place[v]), before.parent(old));
      EXPECT_EQ(mesh.on_axis(place[v]), before.on_axis(old));
    }
    before.edges().for_each([&](const EdgeKey& key, std::int32_t segment) {
      const OrbitVertex a{place[static_cast<std::size_t>(key.a)], 0};
      const OrbitVertex b{place[static_cast<std::size_t>(key.b)], key.exponent};
      EXPECT_EQ(mesh.edges().find(mesh.edge_key(a, b)), segment);
    });
  }
}

}  // namespace
}  // namespace symcell::solid
