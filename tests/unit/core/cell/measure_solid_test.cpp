#include <gtest/gtest.h>

#include <numbers>

#include "core/base/random.hpp"
#include "core/cell/full_mesh.hpp"
#include "core/cell/measure_cell.hpp"
#include "core/cell/quadratic.hpp"
#include "core/geometry/tet_figures.hpp"
#include "tests/support/extruded_cells.hpp"

namespace symcell {
namespace {

TEST(TetFigures, Regular) {
  const TetFigures f = tet_figures({{{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 0}}});
  EXPECT_NEAR(std::abs(f.volume), 1.0 / 3, 1e-15);
  EXPECT_NEAR(degrees_of_cotangent(f.face_cot_max), 60, 1e-12);
  EXPECT_NEAR(degrees_of_cotangent(f.face_cot_min), 60, 1e-12);
  EXPECT_NEAR(degrees_of_cotangent(f.dihedral_cot_max), std::acos(1.0 / 3) * 180 / std::numbers::pi,
              1e-12);
  EXPECT_NEAR(f.radius_edge, std::sqrt(3.0 / 8), 1e-14);
  EXPECT_NEAR(f.aspect, std::sqrt(1.5), 1e-14);
}

TEST(TetFigures, CornerOfACube) {
  const TetFigures f = tet_figures({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}});
  EXPECT_NEAR(f.volume, 8.0 / 6, 1e-14);
  EXPECT_NEAR(degrees_of_cotangent(f.face_cot_max), 45, 1e-12);
  EXPECT_NEAR(degrees_of_cotangent(f.face_cot_min), 90, 1e-12);
  EXPECT_NEAR(degrees_of_cotangent(f.dihedral_cot_min), 90, 1e-12);
  EXPECT_NEAR(degrees_of_cotangent(f.dihedral_cot_max),
              std::atan(std::numbers::sqrt2) * 180 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(f.radius_edge, std::sqrt(3.0) / 2, 1e-14);
  EXPECT_NEAR(f.aspect, std::sqrt(8.0) / (2 / std::sqrt(3.0)), 1e-13);
}

// Flat ones: the angles go to 0 and 180, nothing becomes NaN.
TEST(TetFigures, SliverAngles) {
  const double h = 1e-7;
  const TetFigures f = tet_figures({{{1, 0, h}, {0, 1, 0}, {-1, 0, h}, {0, -1, 0}}});
  EXPECT_LT(std::abs(f.volume), 1e-6);
  EXPECT_NEAR(degrees_of_cotangent(f.dihedral_cot_max), 0, 2e-5);
  EXPECT_NEAR(degrees_of_cotangent(f.dihedral_cot_min), 180, 2e-5);
  EXPECT_GT(f.aspect, 1e6);
  const TetFigures flat = tet_figures({{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}});
  EXPECT_TRUE(std::isinf(flat.aspect));
  EXPECT_FALSE(std::isnan(degrees_of_cotangent(flat.dihedral_cot_min)));
}

// Figures do not depend on the order of the corners, the place or the size.
TEST(TetFigures, AreThoseOfTheShape) {
  Random random(7);
  for (int round = 0; round < 50; ++round) {
    std::array<Point3, 4> p;
    for (Point3& q : p) q = {random.uniform(), random.uniform(), random.uniform()};
    const TetFigures f = tet_figures(p);
    std::array<Point3, 4> moved{p[2], p[0], p[1], p[3]};
    for (Point3& q : moved) q = Point3{3, -2, 1} + 4 * Point3{q.y, q.z, q.x};
    const TetFigures g = tet_figures(moved);
    EXPECT_NEAR(g.volume, 64 * f.volume, 1e-13);
    EXPECT_NEAR(g.radius_edge, f.radius_edge, 1e-8 * f.radius_edge);
    EXPECT_NEAR(g.aspect, f.aspect, 1e-8 * f.aspect);
    EXPECT_NEAR(degrees_of_cotangent(g.face_cot_max), degrees_of_cotangent(f.face_cot_max), 1e-8);
    EXPECT_NEAR(degrees_of_cotangent(g.dihedral_cot_min), degrees_of_cotangent(f.dihedral_cot_min),
                1e-8);
  }
}

TEST(MeasureCell3, CountsAndVolume) {
  for (const test::SolidSample& sample : test::solid_samples()) {
    for (const SymmetryCellMesh& mesh : {sample.cell, elevate_to_quadratic(sample.cell)}) {
      Statistics s;
      measure_cell_3(mesh, s);
      EXPECT_EQ(s.cell.elements, sample.cell.element_count());
      EXPECT_EQ(s.cell.nodes, mesh.nodes.size());
      EXPECT_EQ(s.cell.symmetry_facets, sample.cell.lower_facets.size() / 3);
      EXPECT_EQ(s.full.elements, sample.cell.element_count() * static_cast<std::size_t>(mesh.fold));
      EXPECT_EQ(s.full.nodes, static_cast<std::uint64_t>(FullMeshView(mesh).node_count()));
      EXPECT_NEAR(s.cell.measure * mesh.fold, sample.volume, 1e-9 * sample.volume) << sample.name;
      std::uint64_t binned = 0;
      for (const std::uint64_t bin : s.cell.aspect_ratio_histogram) binned += bin;
      EXPECT_EQ(binned, s.cell.elements);
      EXPECT_GT(s.cell.min_dihedral_deg, 1);
      EXPECT_LT(s.cell.max_dihedral_deg, 179);
    }
  }
}

}  // namespace
}  // namespace symcell
