// Whole surfaces from one sector's.
#include "core/solid/surface/make_whole.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/mesh_model.hpp"
#include "core/solid/surface/clean_surface.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell::solid {
namespace {

// A part of a ring between two copies of a cut that may lean with the radius and the height.
struct SectorShape {
  std::int32_t sectors = 6;
  double inner = 0.5;  // 0: the axis is an edge of it
  double outer = 1;
  double height = 0.5;
  double swirl = 0;              // radians a unit of radius
  double lean = 0;               // radians a unit of height
  double covered = 1;            // of its angle
  bool other_diagonals = false;  // the cuts are triangulated in two ways
};

TriangleSurface sector_surface(const SectorShape& s) {
  constexpr std::int32_t kParts = 4;
  TriangleSurface surface;
  const auto add = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const double r = s.inner + (s.outer - s.inner) * i / kParts, z = s.height * k / kParts;
    const double angle =
        s.swirl * r + s.lean * z + s.covered * 2 * std::numbers::pi / s.sectors * j / kParts;
    surface.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
    return static_cast<std::int32_t>(surface.vertices.size()) - 1;
  };
  // A face of the grid, outwards: u x v looks out.
  const auto face = [&](std::array<std::int32_t, 3> at, std::array<std::int32_t, 3> u,
                        std::array<std::int32_t, 3> v, bool other) {
    for (std::int32_t p = 0; p < kParts; ++p) {
      for (std::int32_t q = 0; q < kParts; ++q) {
        const auto corner = [&](std::int32_t x, std::int32_t y) {
          return add(at[0] + x * u[0] + y * v[0], at[1] + x * u[1] + y * v[1],
                     at[2] + x * u[2] + y * v[2]);
        };
        const std::int32_t a = corner(p, q), b = corner(p + 1, q), c = corner(p + 1, q + 1),
                           d = corner(p, q + 1);
        if (other) {
          surface.triangles.push_back({a, b, d});
          surface.triangles.push_back({b, c, d});
        } else {
          surface.triangles.push_back({a, b, c});
          surface.triangles.push_back({a, c, d});
        }
      }
    }
  };
  constexpr std::array<std::int32_t, 3> r{1, 0, 0}, t{0, 1, 0}, z{0, 0, 1};
  const bool other = s.other_diagonals;
  face({0, 0, 0}, r, z, false);
  face({0, kParts, 0}, z, r, other);
  face({0, 0, 0}, t, r, false);
  face({0, 0, kParts}, r, t, false);
  face({0, 0, 0}, z, t, false);
  face({kParts, 0, 0}, t, z, false);
  return surface;
}

double volume_of(const TriangleSurface& surface) {
  ExecutionContext context;
  const auto clean = clean_surface(surface, context);
  if (!clean || clean->problem) return -1;
  return clean->volume;
}

IndexedSurface cleaned(const TriangleSurface& surface) {
  ExecutionContext context;
  return clean_surface(surface, context)->surface;
}

std::vector<SectorShape> shapes() {
  return {{},
          {.sectors = 2},
          {.sectors = 3, .inner = 0},
          {.sectors = 2, .inner = 0},
          {.sectors = 7, .swirl = 1.3},
          {.sectors = 12, .lean = 0.8},
          {.sectors = 5, .inner = 0, .swirl = 0.9, .lean = -0.7},
          {.sectors = 8, .other_diagonals = true},
          {.sectors = 40, .inner = 0.9}};
}

TEST(MakeWhole, HoldsAllSectorsAndIsClosed) {
  for (const SectorShape& shape : shapes()) {
    SCOPED_TRACE(std::to_string(shape.sectors) + " sectors");
    const TriangleSurface sector = sector_surface(shape);
    const auto whole = make_whole(cleaned(sector), shape.sectors, AxisFrame{}, 1e-6);
    ASSERT_TRUE(whole) << whole.error().message;
    EXPECT_NEAR(volume_of(*whole), shape.sectors * volume_of(sector), 1e-6);
  }
}

TEST(MakeWhole, KnowsAnyAxis) {
  SectorShape shape;
  TriangleSurface sector = sector_surface(shape);
  const Point3 origin{3, -4, 5}, direction{1, 2, -2};
  move_to_axis(sector, origin, direction);
  const auto whole =
      make_whole(cleaned(sector), shape.sectors, AxisFrame::of_axis(origin, direction), 1e-6);
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_NEAR(volume_of(*whole), shape.sectors * volume_of(sector), 1e-6);
}

TEST(MakeWhole, RefusesWhatDoesNotMeet) {
  SectorShape shape;
  shape.covered = 0.9;  // a gap between copies
  const IndexedSurface gap = cleaned(sector_surface(shape));
  EXPECT_EQ(make_whole(gap, 6, AxisFrame{}, 1e-6).error().code, ErrorCode::kNotSymmetric);
  shape.covered = 1;
  const IndexedSurface fits = cleaned(sector_surface(shape));
  EXPECT_EQ(make_whole(fits, 5, AxisFrame{}, 1e-6).error().code, ErrorCode::kNotSymmetric);
  EXPECT_EQ(make_whole(fits, 1, AxisFrame{}, 1e-6).error().code, ErrorCode::kBadFold);
  const AxisFrame beside = AxisFrame::of_axis({0.1, 0, 0}, {0, 0, 1});
  EXPECT_FALSE(make_whole(fits, 6, beside, 1e-6));
}

// From the sector's surface to its cell: bounds are chosen anew, so that they need not be the cuts.
TEST(MakeWhole, SectorsAreMeshedAsTheWholeIs) {
  for (const SectorShape& shape : shapes()) {
    SCOPED_TRACE(std::to_string(shape.sectors) + " sectors");
    MeshOptions options;
    options.sector = shape.sectors;
    ExecutionContext context;
    const TriangleSurface sector = sector_surface(shape);
    const auto outcome = mesh_model(sector, options, context);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->mesh.fold, shape.sectors);
    EXPECT_EQ(outcome->statistics.symmetry.fold, shape.sectors);
    EXPECT_NEAR(outcome->statistics.cell.measure, volume_of(sector), 2e-3 * volume_of(sector));
  }
}

}  // namespace
}  // namespace symcell::solid
