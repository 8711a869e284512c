// The six invalid topologies of [paper] sec. 5.2: each is made by hand, found by its name and
// repaired.
#include "core/solid/cut/repair_cell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/solid/cut/cell_topology.hpp"
#include "core/solid/cut/minimise_bound.hpp"
#include "tests/support/solid_samples.hpp"

namespace symcell::solid {
namespace {

InitialTetrahedralization block(std::int32_t fold) {
  test::PrismShape s;
  s.fold = fold;
  s.steps = 5;
  s.rings = 5;
  s.layers = 5;
  auto solid = test::prism(s);
  test::random_flips(solid.mesh, 2000, 1);
  solid.mesh.compact();
  return solid;
}

// The least cell, with some tetrahedra in a wrong copy.
class RepairCell : public testing::Test {
 protected:
  void start(std::int32_t fold) {
    solid_ = block(fold);
    cell_.emplace(solid_.mesh, 0.0);
    ASSERT_TRUE(minimise_bound(*cell_, context_));
    ASSERT_TRUE(find_cell_flaws(*cell_).empty());
    least_ = cell_->symmetry_faces();
  }
  const QuotientTetrahedralization& mesh() { return solid_.mesh; }
  Representatives& cell() { return *cell_; }

  bool finds(CellFlawKind kind) {
    const auto flaws = find_cell_flaws(cell());
    return std::any_of(flaws.begin(), flaws.end(), [&](const auto& f) { return f.kind == kind; });
  }
  void expect_repaired() {
    const auto usable = repair_cell(cell(), context_);
    ASSERT_TRUE(usable);
    EXPECT_TRUE(*usable);
    EXPECT_TRUE(find_cell_flaws(cell()).empty());
    EXPECT_GE(cell().symmetry_faces(), least_);
    EXPECT_LE(cell().symmetry_faces(), least_ + 12);
  }

  // Whether the tetrahedron and all that share a vertex with it are away from the bounds.
  bool is_deep(TetId t) {
    for (const VertexId v : mesh().tet(t).v) {
      if (mesh().kind(v) != VertexKind::kFree) return false;
      std::vector<TetCopy> star;
      mesh().star(v, star);
      for (const TetCopy& c : star) {
        for (HalfFace h = 4 * c.t; h < 4 * c.t + 4; ++h) {
          if (cell().jump(h) != 0) return false;
        }
      }
    }
    return true;
  }
  TetId deep_tet() {
    for (TetId t = 0; t < mesh().tet_slots(); ++t) {
      if (is_deep(t)) return t;
    }
    ADD_FAILURE() << "no tetrahedron inside";
    return 0;
  }
  // A free vertex whose star is away from the bounds.
  VertexId deep_vertex() { return mesh().tet(deep_tet()).v[0]; }

  InitialTetrahedralization solid_;
  std::optional<Representatives> cell_;
  ExecutionContext context_;
  std::uint64_t least_ = 0;
};

TEST_F(RepairCell, TwoSplitFacesAtAnEdge) {
  start(6);
  // Every other tetrahedron of a ring of four or more goes to the next sector.
  const TetId t = deep_tet();
  for (const auto& e : kEdgeCorners) {
    std::vector<TetCopy> ring;
    ASSERT_TRUE(mesh().ring({t, 0}, mesh().corner(t, e[0]), mesh().corner(t, e[1]), ring));
    if (ring.size() < 4) continue;
    cell().move(ring[0].t, 1);
    cell().move(ring[2].t, 1);
    EXPECT_TRUE(finds(CellFlawKind::kSplitEdge));
    expect_repaired();
    return;
  }
  FAIL() << "no ring of four";
}

TEST_F(RepairCell, SeveralPatchesAtAVertex) {
  start(6);
  // Two tetrahedra that share a vertex and nothing else.
  std::vector<TetCopy> star;
  const VertexId v = deep_vertex();
  mesh().star(v, star);
  for (const TetCopy& a : star) {
    for (const TetCopy& b : star) {
      int shared = 0;
      for (const VertexId x : mesh().tet(a.t).v) {
        shared += static_cast<int>(std::count(mesh().tet(b.t).v, mesh().tet(b.t).v + 4, x));
      }
      if (shared != 1) continue;
      cell().move(a.t, 1);
      cell().move(b.t, 1);
      EXPECT_TRUE(finds(CellFlawKind::kSeveralPatches));
      expect_repaired();
      return;
    }
  }
  FAIL() << "no such pair";
}

TEST_F(RepairCell, SymmetryEdgeWithoutAFace) {
  start(3);
  // Exponents 0, 1, 2 round an edge: 2 and 0 are image and original, but share no face that is a
  // step of one sector.
  const TetId t = deep_tet();
  for (const auto& e : kEdgeCorners) {
    std::vector<TetCopy> ring;
    ASSERT_TRUE(mesh().ring({t, 0}, mesh().corner(t, e[0]), mesh().corner(t, e[1]), ring));
    if (ring.size() < 4) continue;
    cell().move(ring[0].t, 1);
    cell().move(ring[1].t, 2);
    cell().move(ring[2].t, 1);
    EXPECT_TRUE(finds(CellFlawKind::kEdgeWithoutFace));
    expect_repaired();
    return;
  }
  FAIL() << "no ring of four";
}

TEST_F(RepairCell, SymmetryVertexWithoutAFace) {
  start(3);
  // A core at exponent 2 in a coat at exponent 1, the rest of the star at 0.
  const TetId core = deep_tet();
  const VertexId v = mesh().tet(core).v[0];
  cell().move(core, 2);
  for (const HalfFace g : mesh().tet(core).nb) cell().move(tet_of(g), 1);
  CellTopology topology(cell());
  std::vector<CellFlaw> flaws;
  topology.flaws_at(v, &flaws);
  EXPECT_TRUE(std::any_of(flaws.begin(), flaws.end(), [](const CellFlaw& f) {
    return f.kind == CellFlawKind::kVertexWithoutFace;
  }));
  EXPECT_TRUE(finds(CellFlawKind::kVertexWithoutFace));
  expect_repaired();
}

TEST_F(RepairCell, ClosedCap) {
  start(6);
  cell().move(deep_tet(), 1);
  EXPECT_TRUE(finds(CellFlawKind::kClosedCap));
  EXPECT_FALSE(finds(CellFlawKind::kDisconnected));
  expect_repaired();
}

TEST_F(RepairCell, DisconnectedPiece) {
  start(6);
  // A tetrahedron on the surface: its symmetry faces end there.
  for (TetId t = 0; t < mesh().tet_slots(); ++t) {
    const Tet& tet = mesh().tet(t);
    const bool surface = std::count(tet.nb, tet.nb + 4, kNoHalfFace) != 0;
    bool inner = true;
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) inner = inner && cell().jump(h) == 0;
    if (!surface || !inner) continue;
    cell().move(t, -1);
    EXPECT_TRUE(finds(CellFlawKind::kDisconnected));
    EXPECT_FALSE(finds(CellFlawKind::kClosedCap));
    expect_repaired();
    return;
  }
  FAIL() << "no such tetrahedron";
}

TEST_F(RepairCell, FaceTwoSectorsAway) {
  start(6);
  const TetId t = deep_tet();
  const OrbitVertex a = mesh().corner(t, 0), b = mesh().corner(t, 1);
  std::vector<TetCopy> ring;
  ASSERT_TRUE(mesh().ring({t, 0}, a, b, ring));
  cell().move(ring[0].t, 2);
  EXPECT_TRUE(finds(CellFlawKind::kFarFace));
  expect_repaired();
}

TEST_F(RepairCell, SplitEdgeOnTheAxis) {
  start(6);
  for (TetId t = 0; t < mesh().tet_slots(); ++t) {
    for (const auto& e : kEdgeCorners) {
      const OrbitVertex a = mesh().corner(t, e[0]), b = mesh().corner(t, e[1]);
      if (!mesh().on_axis(a.orbit) || !mesh().on_axis(b.orbit)) continue;
      std::vector<TetCopy> ring;
      ASSERT_TRUE(mesh().ring({t, 0}, a, b, ring));
      bool inner = ring.size() >= 4;
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) inner = inner && cell().jump(h) == 0;
      if (!inner) continue;
      cell().move(t, 1);
      EXPECT_TRUE(finds(CellFlawKind::kSplitEdge));
      expect_repaired();
      return;
    }
  }
  FAIL() << "no tetrahedron at the axis away from the bounds";
}

// A share of all tetrahedra in wrong copies: everything at once.
TEST_F(RepairCell, RandomDamage) {
  for (const std::int32_t fold : {2, 3, 6, 17}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      start(fold);
      Random random(seed);
      for (int i = 0; i < 25; ++i) {
        const auto t = static_cast<TetId>(random.next() % mesh().tet_slots());
        cell().move(t, random.next() % 2 == 0 ? 1 : -1);
      }
      EXPECT_FALSE(find_cell_flaws(cell()).empty());
      const auto usable = repair_cell(cell(), context_);
      ASSERT_TRUE(usable);
      EXPECT_TRUE(*usable) << "fold " << fold << " seed " << seed;
      EXPECT_TRUE(find_cell_flaws(cell()).empty());
    }
  }
}

TEST_F(RepairCell, ChainsAreAvoidedWhereThatIsFree) {
  start(6);
  const auto left = avoid_chains(cell(), context_);
  ASSERT_TRUE(left);
  EXPECT_EQ(cell().symmetry_faces(), least_);
  EXPECT_TRUE(find_cell_flaws(cell()).empty());
  // Two loose tetrahedra side by side at exponents 1 and 2 make a chain for nothing.
  const TetId core = deep_tet();
  cell().move(core, 2);
  for (const HalfFace g : mesh().tet(core).nb) cell().move(tet_of(g), 1);
  const auto after = avoid_chains(cell(), context_);
  ASSERT_TRUE(after);
  EXPECT_EQ(*after, *left);
}

// What the flaws stand for, found from the nodes of the cell alone.
class CellItself {
 public:
  explicit CellItself(const Representatives& cell) : cell_(cell), mesh_(cell.mesh()) {
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      std::array<Node, 4> nodes;
      for (std::uint32_t i = 0; i < 4; ++i) {
        const OrbitVertex c =
            mesh_.shift(mesh_.corner(t, i), mesh_.rotations().reduce(cell.exponent(t)));
        nodes[i] = {c.orbit, c.exponent};
      }
      elements_.push_back(nodes);
    }
    for (TetId t = 0; t < elements_.size(); ++t) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        faces_[face(t, i)].push_back(4 * t + i);
        if (mesh_.tet(t).nb[i] == kNoHalfFace) hull_.insert(face(t, i));
      }
    }
  }

  [[nodiscard]] bool usable() { return joined() && bounds_are_pairs(); }

 private:
  using Node = std::pair<VertexId, std::int32_t>;
  using Nodes = std::set<Node>;

  [[nodiscard]] Nodes face(TetId t, std::uint32_t i) const {
    Nodes nodes;
    for (const std::uint32_t c : kFaceCorners[i]) nodes.insert(elements_[t][c]);
    return nodes;
  }
  [[nodiscard]] Nodes turned(const Nodes& nodes) const {
    Nodes result;
    for (const Node& n : nodes) {
      const OrbitVertex c = mesh_.shift(OrbitVertex{n.first, n.second}, 1 % mesh_.fold());
      result.insert({c.orbit, c.exponent});
    }
    return result;
  }

  // The elements that share a node, an edge or nothing at all are joined by faces that share it.
  bool joined() {
    std::map<Nodes, std::vector<TetId>> at;  // elements at a node, an edge
    for (TetId t = 0; t < elements_.size(); ++t) {
      at[{}].push_back(t);
      for (std::uint32_t i = 0; i < 4; ++i) at[{elements_[t][i]}].push_back(t);
      for (const auto& e : kEdgeCorners) at[{elements_[t][e[0]], elements_[t][e[1]]}].push_back(t);
    }
    for (const auto& [shared, tets] : at) {
      std::set<TetId> reached{tets[0]};
      std::vector<TetId> stack{tets[0]};
      while (!stack.empty()) {
        const TetId t = stack.back();
        stack.pop_back();
        for (std::uint32_t i = 0; i < 4; ++i) {
          const Nodes f = face(t, i);
          if (!std::includes(f.begin(), f.end(), shared.begin(), shared.end())) continue;
          for (const HalfFace h : faces_.at(f)) {
            if (reached.insert(tet_of(h)).second) stack.push_back(tet_of(h));
          }
        }
      }
      if (reached.size() != tets.size()) return false;
    }
    return true;
  }

  // Open faces are of the hull, or images of each other; nodes and edges whose image is in the cell
  // lie on such faces.
  bool bounds_are_pairs() {
    std::set<Nodes> lower, higher, parts, lower_parts;
    const auto add_parts = [](const Nodes& f, std::set<Nodes>& to) {
      for (const Node& a : f) {
        for (const Node& b : f) to.insert({a, b});
      }
    };
    for (const auto& [f, halves] : faces_) {
      if (halves.size() > 2) return false;
      add_parts(f, parts);
      if (halves.size() == 2 || hull_.count(f) != 0) continue;
      const auto image = faces_.find(turned(f));
      if (image == faces_.end() || image->second.size() != 1) continue;
      lower.insert(f);
      higher.insert(image->first);
      add_parts(f, lower_parts);
    }
    for (const auto& [f, halves] : faces_) {
      if (halves.size() == 2 || hull_.count(f) != 0) continue;
      if (lower.count(f) == 0 && higher.count(f) == 0) return false;
    }
    for (const Nodes& part : parts) {
      const Nodes image = turned(part);
      if (image == part || parts.count(image) == 0 || lower_parts.count(part) != 0) continue;
      if (std::any_of(part.begin(), part.end(),
                      [&](const Node& n) { return mesh_.on_axis(n.first); })) {
        continue;
      }
      if (mesh_.fold() == 2 && lower_parts.count(image) != 0) continue;
      return false;
    }
    return true;
  }

  const Representatives& cell_;
  const QuotientTetrahedralization& mesh_;
  std::vector<std::array<Node, 4>> elements_;
  std::map<Nodes, std::vector<HalfFace>> faces_;
  std::set<Nodes> hull_;
};

TEST_F(RepairCell, FlawsAreWhatTheCellItselfShows) {
  int usable = 0, flawed = 0;
  for (const std::int32_t fold : {2, 3, 6, 17}) {
    test::PrismShape s;
    s.fold = fold;
    s.steps = fold == 2 ? 2 : 1;
    s.rings = 2;
    s.layers = 2;
    solid_ = test::prism(s);
    Random random(static_cast<std::uint64_t>(fold));
    for (int i = 0; i < 60; ++i) {
      test::random_flips(solid_.mesh, 20, static_cast<std::uint64_t>(i));
      solid_.mesh.compact();
      Representatives cell(solid_.mesh, random.uniform());
      if (i % 2 == 0) {
        ASSERT_TRUE(minimise_bound(cell, context_));
      }
      for (int m = 0; m < i % 4; ++m) {
        const auto t = static_cast<TetId>(random.next() % solid_.mesh.tet_slots());
        cell.move(t, random.next() % 2 == 0 ? 1 : -1);
      }
      const bool none = find_cell_flaws(cell).empty();
      const bool good = CellItself(cell).usable();
      ++(good ? usable : flawed);
      // Small folds forgive more: two sectors ahead is one back. Such faces are flaws all the same.
      if (none || fold > 4) {
        ASSERT_EQ(none, good) << "fold " << fold << ", case " << i;
      }
    }
  }
  EXPECT_GT(usable, 50);
  EXPECT_GT(flawed, 50);
}

}  // namespace
}  // namespace symcell::solid
