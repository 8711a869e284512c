// Shells, Euler characteristic and pinches of quotients of closed surfaces: known figures, and
// those of the surface restored.
#include "core/guard/boundary_topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "core/base/random.hpp"

namespace symcell {
namespace {

struct Surface {
  std::int32_t fold = 1;
  std::vector<std::uint8_t> on_axis;
  std::vector<OrbitTriangle> triangles;

  std::int32_t add_orbit(bool axis = false) {
    on_axis.push_back(axis ? 1 : 0);
    return static_cast<std::int32_t>(on_axis.size()) - 1;
  }
  [[nodiscard]] OrbitVertex copy(std::int32_t orbit, std::int32_t exponent) const {
    const bool fixed = on_axis[static_cast<std::size_t>(orbit)] != 0;
    return {orbit, fixed ? 0 : ((exponent % fold) + fold) % fold};
  }
  void add(OrbitVertex a, OrbitVertex b, OrbitVertex c) { triangles.push_back({a, b, c}); }
  [[nodiscard]] BoundaryTopology topology() const {
    return boundary_topology(fold, on_axis, triangles);
  }
};

// All copies as a surface of fold 1; vertex (orbit, k) becomes orbit * fold + k.
Surface restored(const Surface& s) {
  Surface full;
  full.on_axis.assign(s.on_axis.size() * static_cast<std::size_t>(s.fold), 0);
  for (std::int32_t k = 0; k < s.fold; ++k) {
    for (const OrbitTriangle& t : s.triangles) {
      OrbitTriangle copy;
      for (std::size_t i = 0; i < 3; ++i) {
        const OrbitVertex v = s.copy(t[i].orbit, t[i].exponent + k);
        copy[i] = {v.orbit * s.fold + v.exponent, 0};
      }
      full.triangles.push_back(copy);
    }
  }
  return full;
}

std::vector<std::int32_t> orbits_of(const std::vector<std::int32_t>& vertices, std::int32_t fold) {
  std::set<std::int32_t> orbits;
  for (const std::int32_t v : vertices) orbits.insert(v / fold);
  return {orbits.begin(), orbits.end()};
}

// The quotient gives what the whole surface does.
void expect_law(const Surface& s) {
  const BoundaryTopology quotient = s.topology(), full = restored(s).topology();
  EXPECT_EQ(quotient.shells, full.shells);
  EXPECT_EQ(quotient.euler, full.euler);
  EXPECT_EQ(quotient.open_edges > 0, full.open_edges > 0);
  EXPECT_EQ(quotient.pinched_edges > 0, full.pinched_edges > 0);
  EXPECT_EQ(quotient.pinched_vertices, orbits_of(full.pinched_vertices, s.fold));
  EXPECT_EQ(quotient.touching, orbits_of(full.touching, s.fold));
}

void expect_closed(const Surface& s, std::int64_t shells, std::int64_t euler) {
  SCOPED_TRACE("fold " + std::to_string(s.fold));
  const BoundaryTopology found = s.topology();
  EXPECT_EQ(found.shells, shells);
  EXPECT_EQ(found.euler, euler);
  EXPECT_EQ(found.open_edges, 0U);
  EXPECT_EQ(found.pinched_edges, 0U);
  EXPECT_TRUE(found.pinched_vertices.empty());
  EXPECT_TRUE(found.touching.empty());
  expect_law(s);
}

// Rings round the axis, one of `steps` vertices a sector for each entry of `axis` that is false, a
// pole for each that is true; neighbours joined. `turns`: sectors that a ring goes on by where it
// leaves one.
std::vector<std::int32_t> add_rings(Surface& s,
                                    const std::vector<bool>& axis,
                                    bool closed,
                                    std::int32_t steps,
                                    std::int32_t turns = 1) {
  std::vector<std::int32_t> first;
  for (const bool pole : axis) {
    first.push_back(s.add_orbit(pole));
    for (std::int32_t j = 1; j < steps && !pole; ++j) s.add_orbit();
  }
  const std::size_t count = axis.size();
  for (std::size_t i = 0; i + (closed ? 0 : 1) < count; ++i) {
    const std::size_t next = (i + 1) % count;
    const auto at = [&](std::size_t ring, std::int32_t j) {
      if (axis[ring]) return s.copy(first[ring], 0);
      return s.copy(first[ring] + j % steps, j / steps * turns);
    };
    for (std::int32_t j = 0; j < steps; ++j) {
      if (!axis[i]) s.add(at(i, j), at(i, j + 1), at(next, j));
      if (!axis[next]) s.add(at(next, j), at(i, j + 1), at(next, j + 1));
    }
  }
  return first;
}

// Steps that make rings of three vertices at least.
std::int32_t steps_for(std::int32_t fold, std::int32_t turns = 1) {
  return std::max(1, 3 * std::gcd(fold, turns) / fold + (3 * std::gcd(fold, turns) % fold != 0));
}

void add_sphere(Surface& s, std::int32_t rings = 2) {
  std::vector<bool> axis(static_cast<std::size_t>(rings) + 2, false);
  axis.front() = axis.back() = true;
  add_rings(s, axis, false, steps_for(s.fold));
}

void add_torus(Surface& s, std::int32_t turns = 1) {
  add_rings(s, std::vector<bool>(3, false), true, steps_for(s.fold, turns), turns);
}

// An octahedron off the axis, over given vertices: i and i ^ 1 are opposite.
void add_octahedron(Surface& s, const std::array<OrbitVertex, 6>& v, bool cavity = false) {
  for (std::size_t m = 0; m < 8; ++m) {
    const std::size_t i = m & 1, j = 2 + (m >> 1 & 1), k = 4 + (m >> 2 & 1);
    const bool even = ((i + j + k) % 2 == 0) != cavity;
    s.add(v[i], v[even ? j : k], v[even ? k : j]);
  }
}

std::array<OrbitVertex, 6> new_vertices(Surface& s) {
  std::array<OrbitVertex, 6> v;
  for (OrbitVertex& x : v) x = {s.add_orbit(), 0};
  return v;
}

// Every triangle as one of its copies, and turned.
void shuffle(Surface& s, std::uint64_t seed) {
  Random random(seed);
  for (OrbitTriangle& t : s.triangles) {
    const auto e = static_cast<std::int32_t>(random.next() % static_cast<std::uint64_t>(s.fold));
    for (OrbitVertex& v : t) v = s.copy(v.orbit, v.exponent + e);
    std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random.next() % 3), t.end());
  }
}

class BoundaryTopologyFold : public testing::TestWithParam<std::int32_t> {
 protected:
  BoundaryTopologyFold() { s_.fold = GetParam(); }
  Surface s_;
  std::int64_t n_ = GetParam();
};
INSTANTIATE_TEST_SUITE_P(Folds, BoundaryTopologyFold, testing::Values(1, 2, 3, 4, 6, 12));

TEST_P(BoundaryTopologyFold, Sphere) {
  add_sphere(s_);
  expect_closed(s_, 1, 2);
  shuffle(s_, 1);
  expect_closed(s_, 1, 2);
}

TEST_P(BoundaryTopologyFold, RingAboutTheAxis) {
  add_torus(s_);
  shuffle(s_, 2);
  expect_closed(s_, 1, 0);
}

// Bodies that some rotations take to themselves and others to their neighbours.
TEST_P(BoundaryTopologyFold, RingsThatGoOnSeveralSectorsAtATime) {
  for (std::int32_t turns = 1; turns < s_.fold; ++turns) {
    s_ = {};
    s_.fold = GetParam();
    add_torus(s_, turns);
    shuffle(s_, 3);
    expect_closed(s_, std::gcd(s_.fold, turns), 0);
  }
}

TEST_P(BoundaryTopologyFold, LooseBlocks) {
  add_octahedron(s_, new_vertices(s_));
  expect_closed(s_, n_, 2 * n_);
  add_octahedron(s_, new_vertices(s_), true);
  add_sphere(s_);
  shuffle(s_, 4);
  expect_closed(s_, 2 * n_ + 1, 4 * n_ + 2);
}

TEST_P(BoundaryTopologyFold, NestedShellsOnTheAxis) {
  add_sphere(s_);
  const std::size_t outer = s_.triangles.size();
  add_sphere(s_, 3);
  for (std::size_t t = outer; t < s_.triangles.size(); ++t) {
    std::swap(s_.triangles[t][1], s_.triangles[t][2]);
  }
  expect_closed(s_, 2, 4);
}

// A sphere with a tunnel in each sector, from one triangle of it to another.
TEST_P(BoundaryTopologyFold, ThroughHoles) {
  add_sphere(s_, 5);
  const auto away = [&](std::size_t x, std::size_t y) {
    for (const OrbitVertex& a : s_.triangles[x]) {
      for (const OrbitVertex& b : s_.triangles[y]) {
        if (a.orbit == b.orbit) return false;
      }
    }
    return true;
  };
  std::size_t from = 0, to = 0;
  for (std::size_t x = 0; x < s_.triangles.size(); ++x) {
    for (std::size_t y = 0; y < x; ++y) {
      if (away(x, y) && s_.on_axis[static_cast<std::size_t>(s_.triangles[x][0].orbit)] == 0) {
        from = y;
        to = x;
      }
    }
  }
  ASSERT_TRUE(away(from, to));
  const OrbitTriangle a = s_.triangles[from], b = s_.triangles[to];
  s_.triangles.erase(s_.triangles.begin() + static_cast<std::ptrdiff_t>(to));
  s_.triangles.erase(s_.triangles.begin() + static_cast<std::ptrdiff_t>(from));
  // Vertex i of the one to vertex i of the other turned round, with a ring between.
  std::array<OrbitVertex, 3> ring{};
  for (OrbitVertex& v : ring) v = {s_.add_orbit(), 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const OrbitVertex p = b[(3 - i) % 3], q = b[(3 - j) % 3];
    s_.add(a[i], a[j], ring[i]);
    s_.add(ring[i], a[j], ring[j]);
    s_.add(ring[i], ring[j], p);
    s_.add(p, ring[j], q);
  }
  shuffle(s_, 5);
  expect_closed(s_, 1, 2 - 2 * n_);
}

TEST_P(BoundaryTopologyFold, OpenSurface) {
  add_sphere(s_);
  s_.triangles.pop_back();
  // With one triangle a sector the pole goes with it.
  EXPECT_EQ(s_.topology().open_edges, s_.fold >= 3 ? 1U : 3U);
  EXPECT_EQ(s_.topology().euler, s_.fold >= 3 ? 1 : 2 - n_);
  expect_law(s_);
}

TEST_P(BoundaryTopologyFold, TrianglesTurnedInsideOutAreOpen) {
  add_torus(s_);
  std::swap(s_.triangles[0][0], s_.triangles[0][1]);
  EXPECT_GT(s_.topology().open_edges, 0U);
  expect_law(s_);
}

TEST_P(BoundaryTopologyFold, BlocksThatTouchAtAVertex) {
  const auto a = new_vertices(s_);
  auto b = new_vertices(s_);
  b[2] = a[3];
  add_octahedron(s_, a);
  add_octahedron(s_, b);
  const BoundaryTopology found = s_.topology();
  EXPECT_EQ(found.shells, n_);
  EXPECT_EQ(found.euler, 3 * n_);
  EXPECT_EQ(found.pinched_vertices, std::vector{a[3].orbit});
  EXPECT_EQ(found.touching, std::vector{a[3].orbit});
  EXPECT_EQ(found.pinched_edges, 0U);
  expect_law(s_);
}

TEST_P(BoundaryTopologyFold, BlocksThatTouchAtAnEdge) {
  const auto a = new_vertices(s_);
  auto b = new_vertices(s_);
  b[2] = a[3];
  b[5] = a[4];
  add_octahedron(s_, a);
  add_octahedron(s_, b);
  const BoundaryTopology found = s_.topology();
  EXPECT_EQ(found.shells, n_);
  EXPECT_EQ(found.euler, 3 * n_);
  EXPECT_EQ(found.pinched_edges, 1U);
  EXPECT_TRUE(found.pinched_vertices.empty());
  EXPECT_EQ(found.touching, (std::vector{a[3].orbit, a[4].orbit}));
  expect_law(s_);
}

// Every block touches its own next copy.
TEST_P(BoundaryTopologyFold, BlocksInARowRoundTheAxis) {
  if (s_.fold < 3) return;
  auto v = new_vertices(s_);
  v[1] = {v[0].orbit, 1};
  add_octahedron(s_, v);
  const BoundaryTopology found = s_.topology();
  EXPECT_EQ(found.shells, 1);
  EXPECT_EQ(found.euler, n_);
  EXPECT_EQ(found.pinched_vertices, std::vector{v[0].orbit});
  expect_law(s_);
}

// All copies of a block meet at one point: one fan a sector.
TEST_P(BoundaryTopologyFold, PinchAtAPointOfTheAxis) {
  auto v = new_vertices(s_);
  v[0] = {s_.add_orbit(true), 0};
  add_octahedron(s_, v);
  shuffle(s_, 6);
  const BoundaryTopology found = s_.topology();
  EXPECT_EQ(found.shells, 1);
  EXPECT_EQ(found.euler, 1 + n_);
  if (s_.fold > 1) {
    EXPECT_EQ(found.pinched_vertices, std::vector{v[0].orbit});
    EXPECT_EQ(found.touching, std::vector{v[0].orbit});
  }
  expect_law(s_);
}

// Two bodies about the axis, one on top of the other.
TEST_P(BoundaryTopologyFold, PolesThatTouch) {
  add_rings(s_, {true, false, false, true, false, false, true}, false, steps_for(s_.fold));
  const BoundaryTopology found = s_.topology();
  EXPECT_EQ(found.shells, 1);
  EXPECT_EQ(found.euler, 3);
  EXPECT_EQ(found.pinched_vertices.size(), 1U);
  expect_law(s_);
}

TEST_P(BoundaryTopologyFold, PinchAlongTheAxis) {
  auto v = new_vertices(s_);
  v[0] = {s_.add_orbit(true), 0};
  v[2] = {s_.add_orbit(true), 0};
  add_octahedron(s_, v);
  const BoundaryTopology found = s_.topology();
  EXPECT_EQ(found.shells, 1);
  EXPECT_EQ(found.euler, 1 + n_);
  EXPECT_EQ(found.open_edges, 0U);
  if (s_.fold > 1) {
    EXPECT_EQ(found.pinched_edges, 1U);
    EXPECT_EQ(found.touching, (std::vector{v[0].orbit, v[2].orbit}));
  }
  EXPECT_TRUE(found.pinched_vertices.empty());
  expect_law(s_);
}

// Bodies of all kinds, some joined at vertices or edges or on the axis, some torn open.
TEST(BoundaryTopology, RandomQuotientsAgreeWithTheWhole) {
  int pinched = 0, edges = 0, open = 0, several = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto below = [&](std::int32_t n) {
      return static_cast<std::int32_t>(random.next() % static_cast<std::uint64_t>(n));
    };
    Surface s;
    s.fold = std::array{1, 2, 3, 4, 5, 6, 8, 9, 12, 31}[static_cast<std::size_t>(below(10))];
    std::vector<OrbitVertex> known, poles;  // to join to
    for (std::int32_t body = 1 + below(4); body > 0; --body) {
      const std::size_t before = s.on_axis.size();
      switch (below(4)) {
        case 0: add_sphere(s, 1 + below(3)); break;
        case 1: add_torus(s, s.fold > 1 ? 1 + below(s.fold - 1) : 1); break;
        default: {
          auto v = new_vertices(s);
          if (!known.empty() && below(2) == 0) {
            const auto i = static_cast<std::size_t>(below(static_cast<std::int32_t>(known.size())));
            v[0] = s.copy(known[i].orbit, below(s.fold));
          }
          if (!poles.empty() && below(3) == 0) v[2] = poles.back();
          if (poles.size() > 1 && below(3) == 0) v[4] = poles.front();
          add_octahedron(s, v, below(2) == 0);
        }
      }
      for (std::size_t o = before; o < s.on_axis.size(); ++o) {
        const OrbitVertex v{static_cast<std::int32_t>(o), 0};
        (s.on_axis[o] != 0 ? poles : known).push_back(v);
      }
    }
    if (below(5) == 0) {
      s.triangles.erase(s.triangles.begin() + below(static_cast<std::int32_t>(s.triangles.size())));
    }
    shuffle(s, seed);
    expect_law(s);
    if (testing::Test::HasFailure()) return;
    const BoundaryTopology t = s.topology();
    pinched += t.pinched_vertices.empty() ? 0 : 1;
    edges += t.pinched_edges > 0 ? 1 : 0;
    open += t.open_edges > 0 ? 1 : 0;
    several += t.shells > 1 ? 1 : 0;
  }
  EXPECT_GT(pinched, 20);
  EXPECT_GT(edges, 5);
  EXPECT_GT(open, 50);
  EXPECT_GT(several, 100);
}

}  // namespace
}  // namespace symcell
