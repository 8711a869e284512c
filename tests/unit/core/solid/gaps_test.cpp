// Whole meshes of solids whose facets have gaps and holes, given as facets and as triangles, and of
// solids that touch themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/cell/full_mesh.hpp"
#include "core/guard/boundary_topology.hpp"
#include "core/mesh_model.hpp"
#include "core/model/polygon_triangles.hpp"
#include "tests/support/plc_builders.hpp"

namespace symcell::solid {
namespace {

struct Shape {
  std::string name;
  Plc plc;
  std::int32_t fold;
  double volume;
  std::int64_t euler;
};

std::vector<Shape> shapes() {
  std::vector<Shape> all;
  const auto add_ribbed = [&](const char* name, std::int32_t sides, std::int32_t every,
                              double width) {
    test::RibbedShape s;
    s.sides = sides;
    s.every = every;
    s.half_width = width;
    all.push_back({name, test::ribbed_prism(s), sides / every, test::ribbed_volume(s), 2});
  };
  add_ribbed("U plate", 4, 4, 0.5);
  add_ribbed("narrow U plate", 4, 4, 0.1);
  add_ribbed("two tabs", 4, 2, 0.5);
  add_ribbed("four tabs", 4, 1, 0.3);
  add_ribbed("three ribs", 3, 1, 0.4);
  add_ribbed("six ribs", 6, 1, 0.25);
  for (const std::int32_t sides : {4, 6}) {
    const double unit = 0.5 * sides * std::sin(2 * std::acos(-1.0) / sides);
    const double volume = unit * (4 * 4 * 1 + 1 * 1 * (6 - 1));
    all.push_back({"bar " + std::to_string(sides), test::bar_through_plate(sides, 4, 1, 1, 6),
                   sides, volume, 2});
  }
  return all;
}

TriangleSurface triangles_of(const Plc& plc) {
  TriangleSurface surface;
  surface.vertices = plc.vertices;
  for (std::size_t f = 0; f < plc.facets.size(); ++f) {
    const auto& polygons = plc.facets[f].polygons;
    if (polygons.size() == 1) {
      EXPECT_TRUE(append_polygon(polygons[0], static_cast<std::int32_t>(f), surface));
      continue;
    }
    // A ring between two polygons of as many corners.
    for (std::size_t i = 0; i < polygons[0].size(); ++i) {
      const std::size_t j = (i + 1) % polygons[0].size();
      surface.triangles.push_back({polygons[0][i], polygons[0][j], polygons[1][i]});
      surface.triangles.push_back({polygons[1][i], polygons[0][j], polygons[1][j]});
    }
  }
  surface.source_face.clear();
  return surface;
}

// Upright rhombic blocks round the axis, each touching the next at an edge.
Plc beads(std::int32_t count) {
  Plc plc;
  const double turn = 2 * std::acos(-1.0) / count;
  for (const double z : {0.0, 1.0}) {
    for (std::int32_t k = 0; k < count; ++k) {
      for (const auto& [radius, share] : {std::pair{1.0, 0.0}, {1.3, 0.5}, {0.6, 0.5}}) {
        const double angle = turn * (k + share);
        plc.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
      }
    }
  }
  const std::int32_t above = 3 * count;
  for (std::int32_t k = 0; k < count; ++k) {
    const std::array<std::int32_t, 4> ring = {3 * k, 3 * k + 2, 3 * ((k + 1) % count), 3 * k + 1};
    PlcFacet low, high;
    low.polygons.emplace_back(ring.begin(), ring.end());
    high.polygons = low.polygons;
    for (std::int32_t& v : high.polygons[0]) v += above;
    plc.facets.push_back(low);
    plc.facets.push_back(high);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int32_t a = ring[i], b = ring[(i + 1) % 4];
      PlcFacet wall;
      wall.polygons = {{a, b, b + above, a + above}};
      plc.facets.push_back(wall);
    }
  }
  return plc;
}

// Octahedra round the axis with a common vertex on it.
Plc blocks_at_a_point(std::int32_t count) {
  Plc plc;
  plc.vertices.push_back({0, 0, 0});
  const double turn = 2 * std::acos(-1.0) / count, half = std::min(0.4 * std::tan(turn / 2), 0.4);
  for (std::int32_t k = 0; k < count; ++k) {
    const double c = std::cos(turn * k), s = std::sin(turn * k);
    const auto first = static_cast<std::int32_t>(plc.vertices.size());
    for (const Point3 p :
         {Point3{2, 0, 0}, {1, half, 0}, {1, -half, 0}, {1, 0, 0.5}, {1, 0, -0.5}}) {
      plc.vertices.push_back({c * p.x - s * p.y, s * p.x + c * p.y, p.z});
    }
    for (const std::int32_t end : {0, first}) {
      for (const std::int32_t side : {1, 2}) {
        for (const std::int32_t top : {3, 4}) {
          PlcFacet facet;
          facet.polygons = {{end, first + side, first + top}};
          plc.facets.push_back(facet);
        }
      }
    }
  }
  return plc;
}

BoundaryTopology boundary_of(const SymmetryCellMesh& cell) {
  std::vector<OrbitTriangle> boundary;
  for (std::size_t i = 0; i < cell.boundary.size(); i += 3) {
    OrbitTriangle& t = boundary.emplace_back();
    for (std::size_t j = 0; j < 3; ++j) {
      t[j] = cell.nodes[static_cast<std::size_t>(cell.boundary[i + j])];
    }
  }
  return boundary_topology(cell.fold, cell.on_axis, boundary);
}

void expect_mesh_of(const Model& model, const Shape& shape, std::int32_t fold, double bound) {
  SCOPED_TRACE(shape.name + ", fold " + std::to_string(fold));
  ExecutionContext context;
  context.set_time_limit(60);
  MeshOptions options;
  options.fold = fold;
  options.max_volume = bound;
  const auto made = mesh_model(model, options, context);
  ASSERT_TRUE(made) << made.error().message;
  const SymmetryCellMesh& cell = made->mesh;
  EXPECT_NEAR(fold * made->statistics.cell.measure, shape.volume, 1e-9 * shape.volume);
  const BoundaryTopology found = boundary_of(cell);
  EXPECT_EQ(found.shells, 1);
  EXPECT_EQ(found.euler, shape.euler);
  EXPECT_EQ(found.open_edges, 0U);
  EXPECT_EQ(found.pinched_edges, 0U);
  EXPECT_TRUE(found.pinched_vertices.empty());
}

TEST(SolidsWithGaps, AsFacets) {
  for (const Shape& shape : shapes()) {
    expect_mesh_of(shape.plc, shape, shape.fold, kInfinity);
    expect_mesh_of(shape.plc, shape, shape.fold, shape.volume / 4000);
    if (shape.fold > 1) expect_mesh_of(shape.plc, shape, 1, shape.volume / 1500);
  }
}

TEST(SolidsWithGaps, AsTriangles) {
  for (const Shape& shape : shapes()) {
    const TriangleSurface surface = triangles_of(shape.plc);
    expect_mesh_of(surface, shape, shape.fold, kInfinity);
    expect_mesh_of(surface, shape, 1, shape.volume / 1500);
  }
}

// The pinched edges are divided, on all sides at once.
TEST(SolidsThatTouchThemselves, AtEdges) {
  for (const std::int32_t count : {3, 4, 6}) {
    for (const std::int32_t fold : {1, count}) {
      for (const double max_edge : {kInfinity, 0.3}) {
        SCOPED_TRACE(std::to_string(count) + " beads, fold " + std::to_string(fold));
        ExecutionContext context;
        MeshOptions options;
        options.fold = fold;
        options.max_edge = max_edge;
        const auto made = mesh_model(beads(count), options, context);
        ASSERT_TRUE(made) << made.error().message;
        const BoundaryTopology found = boundary_of(made->mesh);
        EXPECT_EQ(found.shells, 1);
        EXPECT_EQ(found.euler, count);
        EXPECT_EQ(found.open_edges, 0U);
        EXPECT_GE(found.pinched_edges, max_edge < 1 ? 4U : 1U);
      }
    }
  }
}

TEST(SolidsThatTouchThemselves, AtAPointOfTheAxis) {
  for (const std::int32_t count : {2, 3, 4, 6}) {
    for (const std::int32_t fold : {1, count}) {
      for (const double max_edge : {kInfinity, 0.3}) {
        SCOPED_TRACE(std::to_string(count) + " blocks, fold " + std::to_string(fold));
        ExecutionContext context;
        MeshOptions options;
        options.fold = fold;
        options.max_edge = max_edge;
        const auto made = mesh_model(blocks_at_a_point(count), options, context);
        ASSERT_TRUE(made) << made.error().message;
        const BoundaryTopology found = boundary_of(made->mesh);
        EXPECT_EQ(found.shells, 1);
        EXPECT_EQ(found.euler, count + 1);
        EXPECT_EQ(found.pinched_vertices.size(), 1U);
        EXPECT_EQ(found.pinched_edges, 0U);
      }
    }
  }
}

}  // namespace
}  // namespace symcell::solid
