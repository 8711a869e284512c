#include "core/plane/cut/build_cell_mesh.hpp"

#include <set>

#include "core/cell/full_mesh.hpp"
#include "core/cell/pair_images.hpp"
#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

using test::QuotientSample;

SymmetryCellMesh cell_of(const QuotientSample& sample) {
  const auto cut = cut_cell(sample.start.mesh);
  EXPECT_TRUE(cut) << cut.error().message;
  return build_cell_mesh(sample.start, cut.value(), sample.pslg);
}

TEST(BuildCellMesh, KeepsTheInvariantsOfTheCell) {
  for (const std::int32_t fold : {1, 2, 3, 4, 9, 24}) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      const QuotientSample sample = test::random_sample(seed, fold);
      const SymmetryCellMesh cell = cell_of(sample);
      EXPECT_EQ(cell.fold, fold);
      EXPECT_EQ(cell.element_count(), sample.start.mesh.triangle_count());
      EXPECT_EQ(cell.regions.size(), cell.element_count());
      EXPECT_EQ(cell.node_markers.size(), cell.nodes.size());
      EXPECT_EQ(cell.lower_to_higher.size(), cell.nodes.size());
      EXPECT_EQ(cell.lower_facets.size(), cell.higher_facets.size());

      std::set<std::pair<std::int32_t, std::int32_t>> nodes;
      std::set<std::int32_t> orbits, used(cell.elements.begin(), cell.elements.end());
      for (const OrbitVertex n : cell.nodes) {
        EXPECT_TRUE(nodes.insert({n.orbit, n.exponent}).second);
        orbits.insert(n.orbit);
        if (cell.on_axis[static_cast<std::size_t>(n.orbit)] != 0) {
          EXPECT_EQ(n.exponent, 0);
        }
      }
      EXPECT_EQ(orbits.size(), cell.orbit_points.size());
      EXPECT_EQ(used.size(), cell.nodes.size());
    }
  }
}

TEST(BuildCellMesh, BoundsAndBoundaryAreSidesOfElements) {
  for (const std::int32_t fold : {2, 5, 16}) {
    for (std::uint64_t seed = 20; seed < 28; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      const SymmetryCellMesh cell = cell_of(test::random_sample(seed, fold));
      std::set<std::pair<std::int32_t, std::int32_t>> sides;
      for (std::size_t e = 0; e < cell.elements.size(); e += 3) {
        for (std::size_t i = 0; i < 3; ++i) {
          const std::int32_t a = cell.elements[e + i], b = cell.elements[e + (i + 1) % 3];
          EXPECT_TRUE(sides.insert({a, b}).second);
        }
      }
      for (std::size_t i = 0; i < cell.lower_facets.size(); i += 2) {
        const std::pair low{cell.lower_facets[i], cell.lower_facets[i + 1]};
        const std::pair high{cell.higher_facets[i + 1], cell.higher_facets[i]};
        EXPECT_EQ(sides.count(low), 1U);
        EXPECT_EQ(sides.count(high), 1U);  // seen from the other side
        EXPECT_EQ(sides.count({low.second, low.first}), 0U);
      }
      for (std::size_t i = 0; i < cell.boundary.size(); i += 2) {
        EXPECT_EQ(sides.count({cell.boundary[i], cell.boundary[i + 1]}), 1U);
      }
    }
  }
}

TEST(FullMeshView, NumbersEveryNodeAndElementOnce) {
  for (const std::int32_t fold : {1, 2, 6, 25}) {
    const SymmetryCellMesh cell = cell_of(test::random_sample(5, fold));
    const FullMeshView full(cell);
    EXPECT_EQ(full.element_count(), static_cast<std::int64_t>(cell.element_count()) * fold);
    std::set<std::int64_t> ids;
    for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
      for (std::int32_t sector = 0; sector < fold; ++sector) {
        const std::int64_t id = full.node_id(i, sector);
        ids.insert(id);
        const OrbitVertex v = full.node(id);
        EXPECT_EQ(v.orbit, cell.nodes[i].orbit);
        const bool axis = cell.on_axis[static_cast<std::size_t>(v.orbit)] != 0 && fold > 1;
        EXPECT_EQ(v.exponent, axis ? 0 : (cell.nodes[i].exponent + sector) % fold);
      }
      EXPECT_EQ(full.cell_node_position(i), full.position(full.node(full.node_id(i, 0))));
    }
    EXPECT_EQ(static_cast<std::int64_t>(ids.size()), full.node_count());
    EXPECT_EQ(*ids.begin(), 0);
    EXPECT_EQ(*ids.rbegin(), full.node_count() - 1);
  }
}

// Nodes of one orbit that no facet of a bound pairs: images of each other, or too far apart.
TEST(PairBeyondBounds, NodesOneStepApart) {
  SymmetryCellMesh cell;
  cell.fold = 5;
  cell.orbit_points.resize(3);
  cell.on_axis = {0, 0, 1};
  cell.nodes = {{0, 4}, {1, 0}, {0, 0}, {2, 0}, {0, 2}, {1, 2}, {0, 3}};
  cell.lower_to_higher.assign(cell.nodes.size(), -1);
  pair_beyond_bounds(cell);
  EXPECT_EQ(cell.lower_to_higher, (std::vector<std::int32_t>{2, -1, -1, -1, 6, -1, 0}));
  // Each is the other's image: one of them is the lower one.
  cell.fold = 2;
  cell.nodes = {{0, 1}, {1, 0}, {0, 0}};
  cell.lower_to_higher.assign(cell.nodes.size(), -1);
  pair_beyond_bounds(cell);
  EXPECT_EQ(cell.lower_to_higher, (std::vector<std::int32_t>{2, -1, -1}));
}

}  // namespace
}  // namespace symcell::plane
