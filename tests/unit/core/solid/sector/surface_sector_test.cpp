// Exact sectors of surfaces with random triangles: closed, flat where the input is flat, of the
// input's volume and shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/solid/sector/symmetrise.hpp"
#include "core/solid/surface/weld.hpp"
#include "tests/support/sector_checks.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell::solid {
namespace {

MeshOptions with_fold(std::int32_t fold, Point3 origin = {}, Point3 direction = {0, 0, 1}) {
  MeshOptions options;
  options.fold = fold;
  options.axis_origin = origin;
  options.axis_direction = direction;
  return options;
}

void expect_good_sector(const TriangleSurface& surface,
                        const MeshOptions& options,
                        double volume,
                        double distance_rel) {
  ExecutionContext context;
  const auto source = symmetrise_surface(surface, options, context);
  ASSERT_TRUE(source) << source.error().message;
  bool found = false;
  for (std::int32_t i = 0; i < (*source)->candidates() && !found; ++i) {
    const auto sector = (*source)->sector(i, context);
    if (!sector) continue;
    found = true;
    const auto faults = sector_faults(*sector);
    EXPECT_TRUE(faults.empty()) << faults.size() << " faults: " << faults.front();
    const Symmetry& symmetry = (*source)->symmetry();
    const SectorFigures figures = measure_sector(*sector, symmetry, surface);
    EXPECT_NEAR(figures.volume, volume, 1e-3 * volume);
    EXPECT_NEAR(figures.volume, sector->expected_volume, 1e-9 * volume);
    EXPECT_LE(figures.off_surface, distance_rel * symmetry.diameter);
    EXPECT_LE(figures.uncovered, distance_rel * symmetry.diameter);
  }
  EXPECT_TRUE(found);
}

double prism_volume(const PrismShape& shape) {
  const double corner = std::sin(3.14159265358979323846 / shape.fold);
  const double area = shape.fold * shape.outer * shape.inner_tip * corner;
  const double share = shape.bore / shape.outer;
  return shape.height * area * (1 - share * share);
}

// The triangles of a surface as the boundary of a cell.
SymmetryCellMesh boundary_of(const TriangleSurface& surface, const Symmetry& symmetry) {
  SymmetryCellMesh cell;
  cell.dimension = 3;
  cell.fold = symmetry.fold;
  for (const Point3 p : surface.vertices) {
    cell.nodes.push_back({static_cast<std::int32_t>(cell.orbit_points.size()), 0});
    cell.orbit_points.push_back(symmetry.frame.to_local(p));
  }
  for (const Triangle& t : surface.triangles) {
    cell.boundary.insert(cell.boundary.end(), t.begin(), t.end());
  }
  return cell;
}

// The boundary of a prism of five sides, held against that prism.
class PrismBoundary : public testing::Test {
 protected:
  void SetUp() override {
    const TriangleSurface surface = asymmetric_prism(shape, 7);
    auto made = symmetrise_surface(surface, with_fold(shape.fold), context);
    ASSERT_TRUE(made) << made.error().message;
    source = std::move(*made);
    cell = boundary_of(surface, source->symmetry());
  }
  Result<void> check() { return source->check_boundary(cell, context); }

  PrismShape shape;
  ExecutionContext context;
  std::unique_ptr<SectorSource> source;
  SymmetryCellMesh cell;
};

TEST_F(PrismBoundary, FacetsOffTheSurfaceAreFound) {
  const double tolerance = kSurfaceSymmetryToleranceRel * source->symmetry().diameter;
  EXPECT_TRUE(check());
  // The end faces are the lowest and the highest of all.
  const auto top = std::max_element(cell.orbit_points.begin(), cell.orbit_points.end(),
                                    [](const Point3& p, const Point3& q) { return p.z < q.z; });
  top->z += 0.9 * tolerance;
  EXPECT_TRUE(check());
  top->z += 0.2 * tolerance;
  EXPECT_EQ(check().error().code, ErrorCode::kInternal);
}

TEST_F(PrismBoundary, FacetsAcrossTheSolidAreFound) {
  ASSERT_TRUE(check());
  // Its nodes are on the surface, each on another triangle: the first at the bottom, the others at
  // the top, on other sides of the axis.
  const auto at_angle = [&](double z, double angle) {
    std::int32_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < cell.orbit_points.size(); ++i) {
      const double off = distance(
          cell.orbit_points[i], {shape.outer * std::cos(angle), shape.outer * std::sin(angle), z});
      if (off >= least) continue;
      least = off;
      best = static_cast<std::int32_t>(i);
    }
    return best;
  };
  const double high =
      std::max_element(cell.orbit_points.begin(), cell.orbit_points.end(), [](Point3 p, Point3 q) {
        return p.z < q.z;
      })->z;
  cell.boundary = {at_angle(high - shape.height, 0), at_angle(high, 2), at_angle(high, 4)};
  EXPECT_EQ(check().error().code, ErrorCode::kInternal);
}

// Sectors of another surface are held against the input, not against what they are cut from.
TEST(SurfaceSectorSource, SectorsOfAnotherSurfaceAreTheInputs) {
  const PrismShape shape;
  const TriangleSurface given = asymmetric_prism(shape, 7), other = asymmetric_prism(shape, 8);
  ExecutionContext context;
  const auto source = symmetrise_surface(given, with_fold(shape.fold), context);
  ASSERT_TRUE(source) << source.error().message;
  const Symmetry& symmetry = (*source)->symmetry();
  IndexedSurface surface = weld_exactly(other);
  for (Point3& p : surface.points) p = symmetry.frame.to_local(p);
  const auto cut_any = [&](const SectorSource& from) {
    for (std::int32_t i = 0; i < from.preferred(); ++i) {
      if (from.sector(i, context)) return true;
    }
    return false;
  };
  const auto same = (*source)->with_surface(surface);
  ASSERT_TRUE(same);
  EXPECT_TRUE(cut_any(*same));
  const double tolerance = kSurfaceSymmetryToleranceRel * symmetry.diameter;
  for (Point3& p : surface.points) p.z += 1.5 * tolerance;
  EXPECT_FALSE(cut_any(*(*source)->with_surface(surface)));
}

class PrismFolds : public testing::TestWithParam<std::int32_t> {};

TEST_P(PrismFolds, GiveSectorsWithAndWithoutTheAxis) {
  for (const double bore : {0.5, 0.0}) {
    PrismShape shape;
    shape.fold = GetParam();
    shape.bore = bore;
    const TriangleSurface surface = asymmetric_prism(shape, 7);
    expect_good_sector(surface, with_fold(shape.fold), prism_volume(shape), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Sector, PrismFolds, testing::Values(2, 3, 4, 5, 12));

TEST(SurfaceSector, WithoutSymmetryIsTheWholeSurface) {
  const PrismShape shape;
  expect_good_sector(asymmetric_prism(shape, 3), with_fold(1), prism_volume(shape), 1e-6);
}

TEST(SurfaceSector, OfTwistedShapesKeepsWithinTheTolerance) {
  PrismShape shape;
  shape.fold = 7;
  shape.twist = 0.1;
  shape.layers = 12;
  shape.pieces = 6;
  const TriangleSurface surface = asymmetric_prism(shape, 5);
  ExecutionContext context;
  const auto inspection = inspect_surface(surface, with_fold(1), context);
  ASSERT_TRUE(inspection);
  expect_good_sector(surface, with_fold(7), inspection->volume, 1e-3);
}

TEST(SurfaceSector, OfSkewAxesFarFromTheOrigin) {
  const PrismShape shape;
  TriangleSurface surface = asymmetric_prism(shape, 9);
  const Point3 origin{100, -200, 50}, direction{2, -1, 2};
  move_to_axis(surface, origin, direction);
  expect_good_sector(surface, with_fold(5, origin, direction), prism_volume(shape), 1e-6);
}

// A tolerance as wide as the sector is near the axis: less of it is used then.
TEST(SurfaceSector, WideTolerancesLeaveNarrowSectorsWhole) {
  PrismShape shape;
  shape.fold = 24;
  shape.bore = 0;
  MeshOptions options = with_fold(shape.fold);
  options.symmetry_tolerance_rel = 0.05;
  expect_good_sector(asymmetric_prism(shape, 5), options, prism_volume(shape), 0.05);
}

TEST(SurfaceSector, KeepsCavities) {
  PrismShape outer;
  outer.bore = 0;
  PrismShape inner = outer;
  inner.outer = 1;
  inner.inner_tip = 0.7;
  inner.height = 0.4;
  TriangleSurface surface = asymmetric_prism(outer, 1);
  TriangleSurface cavity = asymmetric_prism(inner, 2);
  for (Point3& p : cavity.vertices) p.z += 0.3;
  append(surface, cavity);  // wrongly oriented: nesting decides
  expect_good_sector(surface, with_fold(5), prism_volume(outer) - prism_volume(inner), 1e-6);
}

}  // namespace
}  // namespace symcell::solid
