// The cut of solids on hand-made meshes: the minimum against all choices there are, independence of
// the gauge, and the restored mesh.
#include "core/solid/cut/cut_cell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/cell/full_mesh.hpp"
#include "core/solid/cut/cell_topology.hpp"
#include "core/solid/cut/minimise_bound.hpp"
#include "core/solid/cut/representatives.hpp"
#include "core/solid/quotient/validate.hpp"
#include "tests/support/solid_samples.hpp"

namespace symcell::solid {
namespace {

using test::PrismShape;

CellCut cut(const QuotientTetrahedralization& mesh) {
  ExecutionContext context;
  auto result = cut_cell(mesh, context);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *result : CellCut{};
}

// The fewest faces between different sectors over all choices of exponents.
std::size_t least_faces(const QuotientTetrahedralization& mesh) {
  const std::size_t count = mesh.tet_slots();
  std::vector<std::int32_t> x(count, 0);
  std::size_t best = 1U << 30;
  for (;;) {
    std::size_t faces = 0;
    for (TetId t = 0; t < count; ++t) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        const HalfFace g = mesh.tet(t).nb[i];
        if (g == kNoHalfFace || g < 4 * t + i) continue;
        faces += mesh.add(x[t], mesh.tet(t).off[i]) != x[tet_of(g)] ? 1 : 0;
      }
    }
    best = std::min(best, faces);
    std::size_t at = 1;  // the first one stays: only differences matter
    while (at < count && ++x[at] == mesh.fold()) x[at++] = 0;
    if (at == count) return best;
  }
}

std::vector<PrismShape> random_shapes(int count) {
  std::vector<PrismShape> result;
  for (int i = 0; i < count; ++i) {
    PrismShape s;
    s.fold = std::array{2, 3, 4, 6, 7, 12, 31}[static_cast<std::size_t>(i) % 7];
    s.steps = s.fold == 2 ? 2 + i % 3 : 1 + i % 4;
    s.rings = 1 + i % 5;
    s.layers = 1 + i / 3 % 4;
    s.inner_radius = i % 2 == 0 ? 0 : 1.1;
    s.swirl = 0.3 / (s.fold * s.steps);
    result.push_back(s);
  }
  return result;
}

TEST(SolidCell, BruteForceFindsNoBetterCell) {
  int tried = 0;
  for (const std::int32_t fold : {2, 3, 4, 5}) {
    for (const double inner : {0.0, 1.0}) {
      PrismShape s;
      s.fold = fold;
      s.steps = fold == 2 ? 2 : 1;
      s.inner_radius = inner;
      auto solid = test::prism(s);
      std::size_t choices = 1;
      for (std::size_t i = 1; i < solid.mesh.tet_slots(); ++i) {
        choices *= static_cast<std::size_t>(fold);
      }
      if (choices > 200000) continue;
      ++tried;
      for (std::uint64_t seed = 0; seed < 5; ++seed) {
        test::shuffle_gauge(solid.mesh, seed);
        test::random_flips(solid.mesh, 20, seed);
        solid.mesh.compact();
        if (solid.mesh.tet_slots() > 8) break;
        EXPECT_EQ(cut(solid.mesh).lower.size(), least_faces(solid.mesh)) << fold << " " << inner;
      }
    }
  }
  EXPECT_GE(tried, 5);
}

TEST(SolidCell, GaugeAndStartAreOfNoImportance) {
  for (const PrismShape& s : random_shapes(40)) {
    auto solid = test::prism(s);
    test::random_flips(solid.mesh, 300, 1);
    const std::uint64_t faces = cut(solid.mesh).symmetry_faces;
    test::shuffle_gauge(solid.mesh, 5);
    EXPECT_EQ(cut(solid.mesh).symmetry_faces, faces);
    ExecutionContext context;
    for (const double share : {0.0, 0.4, 0.8}) {
      Representatives cell(solid.mesh, share);
      EXPECT_GE(cell.symmetry_faces(), faces);
      ASSERT_TRUE(minimise_bound(cell, context));
      EXPECT_EQ(cell.symmetry_faces(), faces);
    }
  }
}

// Faces of the full mesh as sorted node triples, with the number of elements at each.
std::map<std::array<std::int64_t, 3>, int> full_faces(const SymmetryCellMesh& mesh) {
  const FullMeshView full(mesh);
  std::map<std::array<std::int64_t, 3>, int> faces;
  for (std::int32_t s = 0; s < mesh.fold; ++s) {
    for (std::size_t e = 0; e < mesh.element_count(); ++e) {
      for (const auto& f : kFaceCorners) {
        std::array<std::int64_t, 3> face{};
        for (std::size_t c = 0; c < 3; ++c) {
          face[c] = full.node_id(static_cast<std::size_t>(mesh.elements[4 * e + f[c]]), s);
        }
        std::sort(face.begin(), face.end());
        ++faces[face];
      }
    }
  }
  return faces;
}

void expect_whole(const InitialTetrahedralization& solid, const PrismShape& s) {
  const CellCut c = cut(solid.mesh);
  const SymmetryCellMesh mesh = build_cell_mesh(solid, c, {});
  ASSERT_EQ(mesh.element_count(), solid.mesh.tet_count());
  // Every element once, no node twice.
  std::set<std::pair<std::int32_t, std::int32_t>> nodes;
  for (const OrbitVertex& v : mesh.nodes) EXPECT_TRUE(nodes.emplace(v.orbit, v.exponent).second);
  const FullMeshView full(mesh);
  double volume = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    std::array<Point3, 4> p;
    for (std::size_t i = 0; i < 4; ++i) {
      p[i] = full.cell_node_position(static_cast<std::size_t>(mesh.elements[4 * e + i]));
    }
    const double v = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 6;
    EXPECT_GT(v, 0);
    volume += v;
  }
  EXPECT_NEAR(volume * s.fold, test::prism_volume(s), 1e-9 * test::prism_volume(s));
  // Conforming: faces in one element are exactly the images of the hull's, which are facets.
  std::set<std::array<std::int64_t, 3>> boundary;
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
    if (mesh.boundary_is_higher_image[f] != 0) continue;
    for (std::int32_t k = 0; k < s.fold; ++k) {
      std::array<std::int64_t, 3> face{};
      for (std::size_t i = 0; i < 3; ++i) {
        face[i] = full.node_id(static_cast<std::size_t>(mesh.boundary[3 * f + i]), k);
      }
      std::sort(face.begin(), face.end());
      EXPECT_TRUE(boundary.insert(face).second);
    }
  }
  std::size_t open = 0;
  for (const auto& [face, count] : full_faces(mesh)) {
    ASSERT_LE(count, 2);
    if (count == 2) continue;
    ++open;
    ASSERT_EQ(boundary.count(face), 1U);
  }
  EXPECT_EQ(boundary.size(), open);  // these samples have no internal facets
  // Bounds are images of each other.
  ASSERT_EQ(mesh.lower_facets.size(), 3 * c.lower.size());
  ASSERT_EQ(mesh.higher_facets.size(), mesh.lower_facets.size());
  for (std::size_t i = 0; i < mesh.lower_facets.size(); ++i) {
    const auto low = static_cast<std::size_t>(mesh.lower_facets[i]);
    ASSERT_EQ(mesh.lower_to_higher[low], mesh.higher_facets[i]);
    const OrbitVertex a = mesh.nodes[low];
    const OrbitVertex b = mesh.nodes[static_cast<std::size_t>(mesh.higher_facets[i])];
    ASSERT_EQ(a.orbit, b.orbit);
    const bool axis = mesh.on_axis[static_cast<std::size_t>(a.orbit)] != 0;
    ASSERT_EQ(b.exponent, axis ? 0 : (a.exponent + 1) % s.fold);
  }
}

TEST(SolidCell, TheRestoredMeshIsWhole) {
  for (const PrismShape& s : random_shapes(30)) {
    auto solid = test::prism(s);
    test::random_flips(solid.mesh, 200, 3);
    test::shuffle_gauge(solid.mesh, 4);
    expect_whole(solid, s);
    if (HasFatalFailure()) return;
  }
  PrismShape plain;
  plain.fold = 1;
  plain.steps = 6;
  plain.rings = 2;
  expect_whole(test::prism(plain), plain);
}

// One tetrahedron spans a sector, some meet their own copies, and random flips wind the layers
// about each other: the least cell is often in pieces.
TEST(SolidCell, VeryCoarseMeshesHaveACellToo) {
  int flawed = 0;
  for (int i = 0; i < 100; ++i) {
    PrismShape s;
    s.fold = std::array{3, 12, 24, 64}[static_cast<std::size_t>(i) % 4];
    s.rings = 2 + i % 3;
    s.layers = 2 + i / 4 % 3;
    s.inner_radius = i % 5 == 0 ? 0.3 : 0;
    s.swirl = 0.3 / s.fold;
    auto solid = test::prism(s);
    const auto seed = static_cast<std::uint64_t>(i);
    test::random_flips(solid.mesh, 300, seed);
    test::jitter(solid.mesh, 0.4, seed);
    test::random_flips(solid.mesh, 300, seed + 1);
    solid.mesh.compact();
    if (!validate(solid.mesh, ValidationLevel::kEmbedding)) continue;
    ExecutionContext context;
    Representatives cell(solid.mesh, 0);
    ASSERT_TRUE(minimise_bound(cell, context));
    flawed += find_cell_flaws(cell).empty() ? 0 : 1;
    EXPECT_TRUE(cut_cell(solid.mesh, context)) << i;
  }
  EXPECT_GT(flawed, 3);
}

// Six wedges of a disc, parted by walls, with attributes of their own; a ring round them in one
// part.
TEST(SolidCell, RegionsMayDifferBetweenSectors) {
  PrismShape s;
  s.fold = 6;
  s.steps = 2;
  s.rings = 3;
  s.layers = 2;
  auto solid = test::prism(s);
  QuotientTetrahedralization& mesh = solid.mesh;
  // Walls: the half-planes through the first column of each sector, between axis and ring 2, and
  // the surface of ring 2.
  const auto on_wall = [&](TetId t, std::uint32_t face) {
    double radius[3], angle[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const Point3 p = mesh.corner_point(t, kFaceCorners[face][c]);
      radius[c] = std::hypot(p.x, p.y);
      angle[c] =
          radius[c] < 1e-9 ? -1 : std::fmod(std::atan2(p.y, p.x) / (M_PI / 3) + 12 + 1e-9, 1);
    }
    const auto all = [&](auto&& holds) { return holds(0) && holds(1) && holds(2); };
    const double ring = s.outer_radius * 2 / 3;
    return all([&](std::size_t c) { return std::abs(radius[c] - ring) < 1e-9; }) ||
           all([&](std::size_t c) {
             return radius[c] < ring + 1e-9 && (angle[c] < 0 || angle[c] < 1e-6);
           });
  };
  const auto wall = static_cast<std::int32_t>(solid.facet_markers.size());
  solid.facet_markers.push_back(9);
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (mesh.tet(t).nb[i] != kNoHalfFace && on_wall(t, i)) mesh.tet(t).facet[i] = wall;
    }
  }
  test::shuffle_gauge(mesh, 8);
  const auto seed = [&](double radius, int sector, std::int32_t attribute) {
    const double angle = (sector + 0.4) * M_PI / 3;
    solid.seeds.push_back(
        {{radius * std::cos(angle), radius * std::sin(angle), 0.3}, attribute, 1e300});
  };
  for (int k = 0; k < 6; k += 2) seed(0.7, k, 10 + k);
  seed(1.6, 3, 99);
  solid.regions_differ = true;
  const CellCut c = cut(mesh);
  const SymmetryCellMesh cell = build_cell_mesh(solid, c, {});
  ASSERT_EQ(cell.sector_regions.size(), 6 * cell.element_count());
  const FullMeshView full(cell);
  for (std::size_t e = 0; e < cell.element_count(); ++e) {
    Point3 middle{};
    for (std::size_t i = 0; i < 4; ++i) {
      middle = middle +
               0.25 * full.cell_node_position(static_cast<std::size_t>(cell.elements[4 * e + i]));
    }
    for (std::int32_t k = 0; k < 6; ++k) {
      const Point3 p = mesh.rotations().rotate(middle, k);
      const double turn = std::atan2(p.y, p.x) / (M_PI / 3);
      const int sector = static_cast<int>(std::floor(turn + 6)) % 6;
      const bool outer = std::hypot(p.x, p.y) > s.outer_radius * 2 / 3 * std::cos(M_PI / 12);
      const std::int32_t expected = outer ? 99 : sector % 2 == 0 ? 10 + sector : 0;
      ASSERT_EQ(cell.region(e, k), expected) << e << " " << k;
    }
    ASSERT_EQ(cell.regions[e], cell.region(e, 0));
  }
}

}  // namespace
}  // namespace symcell::solid
