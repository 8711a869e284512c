// Fewer and better triangles for the same surface: closed, within the distance, flat where it was
// flat, with its edges, and the same at both images of the cut.
#include "core/solid/surface/improve_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/solid/surface/surface_edits.hpp"
#include "tests/unit/core/solid/surface_checks.hpp"

namespace symcell::solid {
namespace {

constexpr FlatnessTolerances kFlatness{1e-6, 1e-6};
// The new surface is looked at in more places here than where it is made.
constexpr double kSlack = 1.1;

void improve(QuotientSurface& surface, double most) {
  ExecutionContext context;
  const auto flat = flatten_planar_patches(surface, kFlatness, context);
  ASSERT_TRUE(flat) << flat.error().message;
  const auto done = improve_surface(surface, most, kFlatness, context);
  ASSERT_TRUE(done) << done.error().message;
  test::expect_sound(surface);
  EXPECT_EQ(surface.patch.size(), surface.triangles.size());
  EXPECT_EQ(surface.frame.size(), surface.triangles.size());
  EXPECT_EQ(surface.normals.size(), surface.triangles.size());
  // Patches are planar still.
  const RotationTable rotations(surface.fold);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.patch[t] < 0) continue;
    const Plane plane = rotated(surface.planes[surface.patch[t]], rotations, surface.frame[t]);
    for (const OrbitVertex& v : surface.triangles[t]) {
      EXPECT_LE(std::abs(plane.height(corner_point(surface, rotations, v))), 1e-10);
    }
  }
}

double worst_shape(const QuotientSurface& s) {
  const RotationTable rotations(s.fold);
  double worst = 1;
  for (const QuotientTriangle& t : s.triangles) {
    worst = std::min(worst,
                     shape_of({corner_point(s, rotations, t[0]), corner_point(s, rotations, t[1]),
                               corner_point(s, rotations, t[2])}));
  }
  return worst;
}

std::size_t planar_triangles(const QuotientSurface& s) {
  return static_cast<std::size_t>(
      std::count_if(s.patch.begin(), s.patch.end(), [](std::int32_t p) { return p >= 0; }));
}

class ImprovedPrisms : public testing::TestWithParam<std::int32_t> {};

// All flat: the same body with fewer triangles, whatever the distance.
TEST_P(ImprovedPrisms, KeepVolumePlanesAndEdges) {
  for (const double bore : {0.5, 0.0}) {
    PrismShape shape;
    shape.fold = GetParam();
    shape.bore = bore;
    const TriangleSurface prism = asymmetric_prism(shape, 5);
    QuotientSurface surface = test::one_sector(prism, shape.fold, 0.21);
    const IndexedSurface before = test::restored(surface);
    improve(surface, 0.01);
    const IndexedSurface after = test::restored(surface);
    EXPECT_NEAR(test::volume_of(after), test::star_volume(shape), 1e-9);
    EXPECT_LT(test::distance_between(before, after), 1e-9);
    EXPECT_LT(after.triangles.size(), before.triangles.size());
    EXPECT_EQ(planar_triangles(surface), surface.triangles.size());
    EXPECT_EQ(test::euler_characteristic(after), test::euler_characteristic(before));
    // The corners of the star.
    for (std::int32_t i = 0; i < 2 * shape.fold; ++i) {
      const double angle = std::numbers::pi * i / shape.fold;
      const double r = i % 2 == 0 ? shape.outer : shape.inner_tip;
      for (const double z : {0.0, shape.height}) {
        const Point3 corner{r * std::cos(angle), r * std::sin(angle), z};
        EXPECT_TRUE(std::any_of(after.points.begin(), after.points.end(),
                                [&](const Point3& p) { return distance(p, corner) < 1e-9; }));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Folds, ImprovedPrisms, testing::Values(2, 3, 5, 12));

// A finely divided sphere, whole and cut: the coarser the farther it may go.
TEST(ImproveSurface, CurvedPartsKeepDistanceAndVolume) {
  for (const std::int32_t fold : {1, 2, 4}) {
    std::size_t last = 0;
    for (const double most : {0.005, 0.012, 0.03}) {
      SCOPED_TRACE(testing::Message() << fold << "-fold, " << most);
      QuotientSurface surface =
          fold == 1 ? test::uncut(test::sphere(4)) : test::one_sector(test::sphere(4), fold, 0.33);
      const IndexedSurface before = test::restored(surface);
      improve(surface, most);
      const IndexedSurface after = test::restored(surface);
      // At the cut are narrow corners, and twice the distance is allowed for opening them.
      const double allowed = kSlack * (fold == 1 ? 1 : 2) * most;
      EXPECT_LE(test::distance_between(before, after), allowed);
      EXPECT_NEAR(test::volume_of(after), test::volume_of(before), most);
      EXPECT_EQ(test::euler_characteristic(after), 2);
      EXPECT_LT(after.triangles.size(), before.triangles.size());
      if (last > 0) {
        EXPECT_LT(after.triangles.size(), last);
      }
      last = after.triangles.size();
      EXPECT_GT(worst_shape(surface), 0.1);
    }
  }
}

// Long thin triangles of a twisted star get better shapes; bottom and top stay planes.
TEST(ImproveSurface, TwistedSidesGetBetterShapes) {
  PrismShape shape;
  shape.fold = 7;
  shape.twist = 0.4;
  shape.layers = 20;
  shape.pieces = 6;
  constexpr double kMost = 0.02;
  QuotientSurface surface = test::one_sector(asymmetric_prism(shape, 5), shape.fold, 0.2, 0.02);
  const double shape_before = worst_shape(surface);
  const IndexedSurface before = test::restored(surface);
  improve(surface, kMost);
  const IndexedSurface after = test::restored(surface);
  EXPECT_LE(test::distance_between(before, after), kSlack * kMost);
  EXPECT_NEAR(test::volume_of(after), test::volume_of(before), 1e-3 * test::volume_of(before));
  EXPECT_GT(worst_shape(surface), 2 * shape_before);
  EXPECT_GT(planar_triangles(surface), 0U);
  EXPECT_LT(planar_triangles(surface), surface.triangles.size());
}

TEST(ImproveSurface, RefusesWhatIsNotClosedAndStops) {
  ExecutionContext context;
  QuotientSurface open = test::uncut(test::sphere(1));
  open.triangles.pop_back();
  open.patch.pop_back();
  open.frame.pop_back();
  EXPECT_EQ(improve_surface(open, 0.01, kFlatness, context).error().code, ErrorCode::kInternal);
  QuotientSurface ball = test::uncut(test::sphere(4));
  context.cancel();
  EXPECT_EQ(improve_surface(ball, 0.01, kFlatness, context).error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace symcell::solid
