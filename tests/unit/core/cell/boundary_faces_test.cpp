#include "core/cell/boundary_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/cell/full_mesh.hpp"
#include "core/cell/quadratic.hpp"
#include "tests/support/extruded_cells.hpp"

namespace symcell {
namespace {

using Triangle = std::array<std::int32_t, 3>;

Triangle sorted(Triangle t) {
  std::ranges::sort(t);
  return t;
}

std::set<Triangle> facets(const std::vector<std::int32_t>& nodes) {
  std::set<Triangle> result;
  for (std::size_t i = 0; i < nodes.size(); i += 3) {
    result.insert(sorted({nodes[i], nodes[i + 1], nodes[i + 2]}));
  }
  return result;
}

TEST(BoundaryFaces, AreTheModelsAndTheTwoBounds) {
  for (const test::SolidSample& sample : test::solid_samples()) {
    std::set<Triangle> model;
    for (std::size_t b = 0; b < sample.cell.facet_count(); ++b) {
      if (sample.cell.boundary_markers[b] == test::kPlateMarker) continue;  // inside
      const auto& all = sample.cell.boundary;
      model.insert(sorted({all[3 * b], all[3 * b + 1], all[3 * b + 2]}));
    }
    std::set<Triangle> bounds = facets(sample.cell.lower_facets);
    bounds.merge(facets(sample.cell.higher_facets));
    std::set<Triangle> outer;
    std::set<Triangle> inner;
    for (const BoundaryFace& face : boundary_faces(sample.cell)) {
      EXPECT_TRUE((face.outer ? outer : inner).insert(sorted(face.corners)).second);
    }
    EXPECT_EQ(outer, model) << sample.name;
    EXPECT_EQ(inner, bounds) << sample.name;
  }
}

// The divergence theorem over all sectors.
TEST(BoundaryFaces, OuterOnesEncloseTheVolume) {
  for (const test::SolidSample& sample : test::solid_samples()) {
    for (const SymmetryCellMesh& mesh : {sample.cell, elevate_to_quadratic(sample.cell)}) {
      const FullMeshView view(mesh);
      double outside = 0;
      double all = 0;
      for (const BoundaryFace& face : boundary_faces(mesh)) {
        for (std::int32_t s = 0; s < (face.outer ? mesh.fold : 1); ++s) {
          std::array<Point3, 3> p;
          for (std::size_t i = 0; i < 3; ++i) {
            const auto node = static_cast<std::size_t>(face.corners[i]);
            p[i] = view.position(view.node(view.node_id(node, s))) - mesh.axis_origin;
          }
          const double part = dot(cross(p[0], p[1]), p[2]) / 6;
          if (face.outer) outside += part;
          if (s == 0) all += part;
        }
      }
      EXPECT_NEAR(outside, sample.volume, 1e-9 * sample.volume) << sample.name;
      EXPECT_NEAR(all * mesh.fold, sample.volume, 1e-9 * sample.volume) << sample.name;
    }
  }
}

// A half turn about the axis through o and q: element (o, v, Rv, w) is its own neighbour across
// (o, v, Rv).
TEST(BoundaryFaces, FaceThatIsItsOwnImageIsInside) {
  SymmetryCellMesh mesh;
  mesh.dimension = 3;
  mesh.fold = 2;
  mesh.nodes_per_element = 4;
  mesh.nodes_per_facet = 3;
  mesh.orbit_points = {{0, 0, 0}, {1, 0, 1}, {0, 1, 0.5}};
  mesh.on_axis = {1, 0, 0};
  mesh.nodes = {{0, 0}, {1, 0}, {1, 1}, {2, 0}};
  mesh.node_markers.assign(4, 0);
  mesh.elements = {0, 2, 1, 3};
  mesh.regions = {0};
  mesh.lower_to_higher = {0, 2, -1, -1};
  int outer = 0;
  for (const BoundaryFace& face : boundary_faces(mesh)) {
    EXPECT_EQ(face.outer, sorted(face.corners) != (Triangle{0, 1, 2}));
    outer += face.outer ? 1 : 0;
  }
  EXPECT_EQ(outer, 3);
}

}  // namespace
}  // namespace symcell
