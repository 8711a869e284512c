#include "core/cell/quadratic.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/cell/full_mesh.hpp"
#include "tests/support/sample_cells.hpp"

namespace symcell {
namespace {

TEST(Quadratic, OneMidNodeAnEdgeAtItsMidpoint) {
  for (const test::Sample& sample : test::all_samples()) {
    const SymmetryCellMesh mesh = elevate_to_quadratic(sample.cell);
    const FullMeshView view(mesh);
    EXPECT_EQ(mesh.order, 2);
    ASSERT_EQ(mesh.nodes_per_element, 6);
    ASSERT_EQ(mesh.elements.size(), sample.cell.elements.size() * 2);
    std::set<std::pair<std::int32_t, std::int32_t>> edges;
    for (std::size_t e = 0; e < mesh.element_count(); ++e) {
      const std::int32_t* nodes = &mesh.elements[e * 6];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = nodes[i];
        const std::int32_t b = nodes[(i + 1) % 3];
        edges.emplace(std::minmax(a, b));
        const Point3 p = view.cell_node_position(static_cast<std::size_t>(a));
        const Point3 q = view.cell_node_position(static_cast<std::size_t>(b));
        const Point3 m = view.cell_node_position(static_cast<std::size_t>(nodes[3 + i]));
        EXPECT_NEAR(m.x, 0.5 * (p.x + q.x), 1e-14);
        EXPECT_NEAR(m.y, 0.5 * (p.y + q.y), 1e-14);
      }
    }
    EXPECT_EQ(mesh.nodes.size(), sample.cell.nodes.size() + edges.size()) << sample.name;
  }
}

TEST(Quadratic, NodesAreDistinctOrbitCopies) {
  for (const test::Sample& sample : test::all_samples()) {
    const SymmetryCellMesh mesh = elevate_to_quadratic(sample.cell);
    std::set<std::pair<std::int32_t, std::int32_t>> copies;
    std::set<std::int32_t> orbits;
    for (const OrbitVertex& v : mesh.nodes) {
      EXPECT_TRUE(copies.emplace(v.orbit, v.exponent).second);
      orbits.insert(v.orbit);
    }
    EXPECT_EQ(orbits.size(), mesh.orbit_points.size());
    EXPECT_EQ(mesh.on_axis.size(), mesh.orbit_points.size());
  }
}

// V - E + F of the full mesh with its mid nodes: nodes = V + E.
TEST(Quadratic, BoundsShareTheirMidNodes) {
  for (const test::Sample& sample : test::all_samples()) {
    const SymmetryCellMesh mesh = elevate_to_quadratic(sample.cell);
    const FullMeshView corners(sample.cell);
    const FullMeshView all(mesh);
    const std::int64_t faces = corners.element_count();
    std::int64_t boundary = 0;
    for (std::size_t b = 0; b < sample.cell.facet_count(); ++b) {
      boundary += sample.cell.boundary_markers[b] != 5 ? sample.cell.fold : 0;  // 5: an inner one
    }
    const std::int64_t edges = (3 * faces + boundary) / 2;
    EXPECT_EQ(all.node_count(), corners.node_count() + edges) << sample.name;
    for (std::size_t i = 0; i < mesh.lower_facets.size(); ++i) {
      const auto low = static_cast<std::size_t>(mesh.lower_facets[i]);
      EXPECT_EQ(mesh.lower_to_higher[low], mesh.higher_facets[i]);
    }
  }
}

TEST(Quadratic, MidNodesOnTheBoundaryAreMarked) {
  const SymmetryCellMesh mesh = elevate_to_quadratic(test::square_cell());
  for (std::size_t b = 0; b < mesh.boundary_markers.size(); ++b) {
    const auto mid = static_cast<std::size_t>(mesh.boundary[3 * b + 2]);
    EXPECT_EQ(mesh.node_markers[mid], mesh.boundary_markers[b]);
  }
}

}  // namespace
}  // namespace symcell
