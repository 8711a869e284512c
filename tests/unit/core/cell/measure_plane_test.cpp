#include <algorithm>
#include <numbers>

#include "core/cell/full_mesh.hpp"
#include "core/cell/measure_cell.hpp"
#include "core/plane/cut/build_cell_mesh.hpp"
#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell {
namespace {

SymmetryCellMesh cell_of(const plane::test::QuotientSample& sample) {
  const auto cut = plane::cut_cell(sample.start.mesh);
  EXPECT_TRUE(cut) << cut.error().message;
  return plane::build_cell_mesh(sample.start, cut.value(), sample.pslg);
}

TEST(MeasureCell, OneEquilateralTriangleASector) {
  Statistics s;
  measure_cell_2(cell_of(plane::test::wheel(6, false)), s);
  EXPECT_EQ(s.cell.elements, 1U);
  EXPECT_EQ(s.cell.nodes, 3U);
  EXPECT_EQ(s.cell.symmetry_nodes, 2U);  // the centre and the lower rim vertex
  EXPECT_EQ(s.cell.symmetry_facets, 1U);
  EXPECT_EQ(s.full.elements, 6U);
  EXPECT_EQ(s.full.nodes, 7U);
  EXPECT_NEAR(s.cell.measure, std::sqrt(3.0) / 4, 1e-15);
  EXPECT_NEAR(s.cell.min_angle_deg, 60, 1e-12);
  EXPECT_NEAR(s.cell.max_angle_deg, 60, 1e-12);
  EXPECT_NEAR(s.cell.max_radius_edge, 1 / std::sqrt(3.0), 1e-14);
  EXPECT_EQ(s.cell.aspect_ratio_histogram[0], 1U);  // 2 / sqrt(3)
}

TEST(MeasureCell, FiguresAreThoseOfTheElements) {
  constexpr double kEdges[] = {1.5, 2, 2.5, 3, 4, 6, 10, 15};
  for (const std::int32_t fold : {1, 3, 10}) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      SCOPED_TRACE("fold " + std::to_string(fold) + " seed " + std::to_string(seed));
      const SymmetryCellMesh cell = cell_of(plane::test::random_sample(seed, fold));
      const FullMeshView full(cell);
      Statistics s;
      measure_cell_2(cell, s);
      double least = 180, most = 0, area = 0, radius_edge = 0;
      std::array<std::uint64_t, kAspectBins> bins{};
      for (std::size_t e = 0; e < cell.element_count(); ++e) {
        Point2 p[3];
        for (std::size_t i = 0; i < 3; ++i) {
          const Point3 q =
              full.cell_node_position(static_cast<std::size_t>(cell.elements[3 * e + i]));
          p[i] = {q.x, q.y};
        }
        const double a = distance(p[1], p[2]), b = distance(p[2], p[0]), c = distance(p[0], p[1]);
        const double element = 0.5 * cross(p[1] - p[0], p[2] - p[0]);
        const double longest = std::max({a, b, c}), shortest = std::min({a, b, c});
        area += element;
        radius_edge = std::max(radius_edge, a * b * c / (4 * element) / shortest);
        const double aspect = longest / (2 * element / longest);
        ++bins[static_cast<std::size_t>(std::count_if(
            std::begin(kEdges), std::end(kEdges), [&](double edge) { return aspect >= edge; }))];
        for (int i = 0; i < 3; ++i) {
          const Point2 u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
          const double angle = std::atan2(cross(u, v), dot(u, v)) * 180 / std::numbers::pi;
          least = std::min(least, angle);
          most = std::max(most, angle);
        }
      }
      EXPECT_NEAR(s.cell.measure, area, 1e-12 * area);
      EXPECT_NEAR(s.cell.min_angle_deg, least, 1e-9);
      EXPECT_NEAR(s.cell.max_angle_deg, most, 1e-9);
      EXPECT_NEAR(s.cell.max_radius_edge, radius_edge, 1e-9 * radius_edge);
      EXPECT_EQ(s.cell.aspect_ratio_histogram, bins);
      EXPECT_EQ(s.cell.elements, cell.element_count());
      EXPECT_EQ(s.full.nodes, static_cast<std::uint64_t>(full.node_count()));
    }
  }
}

}  // namespace
}  // namespace symcell
