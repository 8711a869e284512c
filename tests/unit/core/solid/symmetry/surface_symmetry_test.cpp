// Axis and fold of shapes, detected or checked.
#include <gtest/gtest.h>

#include <cmath>

#include "core/solid/sector/symmetrise.hpp"
#include "core/solid/surface/mass_properties.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell::solid {
namespace {

SolidInspection inspected(const TriangleSurface& surface, const MeshOptions& options = {}) {
  ExecutionContext context;
  auto result = inspect_surface(surface, options, context);
  EXPECT_TRUE(result) << result.error().message;
  return result.value_or(SolidInspection{});
}

double axis_angle(const SolidInspection& inspection, Point3 direction) {
  return length(cross(inspection.axis_direction, (1 / length(direction)) * direction));
}

class DetectedFolds : public testing::TestWithParam<std::int32_t> {};

TEST_P(DetectedFolds, OfStarPrismsAboutSkewAxes) {
  PrismShape shape;
  shape.fold = GetParam();
  TriangleSurface surface = asymmetric_prism(shape, 11);
  const Point3 direction{1, 2, -2};
  move_to_axis(surface, {5, -3, 1}, direction);
  const SolidInspection found = inspected(surface);
  EXPECT_EQ(found.fold, shape.fold);
  EXPECT_LT(axis_angle(found, direction), 1e-6);
  EXPECT_LT(found.symmetry_error_rel, 1e-6);
  EXPECT_EQ(found.problem, "");
}

INSTANTIATE_TEST_SUITE_P(SurfaceSymmetry, DetectedFolds, testing::Values(3, 5, 8, 17));

TEST(SurfaceSymmetry, OfACubeIsFourfoldOrAsGiven) {
  const TriangleSurface cube = box_surface({-1, -1, -1}, {1, 1, 1});
  EXPECT_EQ(inspected(cube).fold, 4);
  MeshOptions options;
  options.fold = 3;
  const SolidInspection found = inspected(cube, options);
  EXPECT_EQ(found.fold, 3);
  const Point3 d = found.axis_direction;
  EXPECT_NEAR(std::abs(d.x), 1 / std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(std::abs(d.y), 1 / std::sqrt(3.0), 1e-6);
}

TEST(SurfaceSymmetry, OfARevolutionIsAmbiguousUnlessGiven) {
  PrismShape shape;  // a fine, irregular polygon on a circle
  shape.fold = 60;
  shape.inner_tip = shape.outer;
  shape.pieces = 1;
  TriangleSurface surface = asymmetric_prism(shape, 2);
  for (Point3& p : surface.vertices) {
    const double angle = std::atan2(p.y, p.x) + 0.02 * std::sin(5 * std::atan2(p.y, p.x) + 1) +
                         0.015 * std::sin(7 * std::atan2(p.y, p.x));
    const double r = std::hypot(p.x, p.y);
    p.x = r * std::cos(angle);
    p.y = r * std::sin(angle);
  }
  ExecutionContext context;
  const auto refused = symmetrise_surface(surface, {}, context);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kAmbiguousSymmetry);
  MeshOptions options;
  options.fold = 6;
  const auto accepted = symmetrise_surface(surface, options, context);
  ASSERT_TRUE(accepted) << accepted.error().message;
  EXPECT_EQ((*accepted)->symmetry().fold, 6);
}

// Within a wide tolerance every small turn fits, and most folds at a first look.
TEST(SurfaceSymmetry, NearRevolutionsHaveTheFoldThatStandsOut) {
  for (const std::int32_t fold : {9, 14, 30}) {
    PrismShape shape;
    shape.fold = fold;
    shape.inner_tip = 1.8;
    MeshOptions options;
    options.symmetry_tolerance_rel = 0.02;
    ExecutionContext context;
    const auto source = symmetrise_surface(asymmetric_prism(shape, 3), options, context);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ((*source)->symmetry().fold, fold);
  }
}

TEST(SurfaceSymmetry, OfNothingIsFoldOne) {
  TriangleSurface surface = box_surface({0, 0, 0}, {3, 2, 1});
  for (Point3& p : surface.vertices) {
    p.x += 0.2 * p.y * p.y + 0.1 * p.z;
    p.y += 0.3 * p.x * p.z;
  }
  EXPECT_EQ(inspected(surface).fold, 1);
}

TEST(SurfaceSymmetry, RefusesWrongFoldsAndAxes) {
  const TriangleSurface surface = asymmetric_prism({}, 4);
  ExecutionContext context;
  MeshOptions options;
  options.fold = 4;
  const auto wrong = symmetrise_surface(surface, options, context);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, ErrorCode::kNotSymmetric);
  EXPECT_NE(wrong.error().message.find("4-fold"), std::string::npos);
  options.fold = 0;
  EXPECT_EQ(symmetrise_surface(surface, options, context).error().code, ErrorCode::kBadFold);
  options.fold = 5;
  options.axis_direction = Point3{0, 0, 0};
  EXPECT_EQ(symmetrise_surface(surface, options, context).error().code, ErrorCode::kBadAxis);
}

TEST(MassProperties, OfABox) {
  ExecutionContext context;
  IndexedSurface box;
  const TriangleSurface given = box_surface({1, 1, 1}, {2, 3, 4});
  box.points = given.vertices;
  box.triangles = given.triangles;
  const MassProperties mass = mass_properties(box);
  EXPECT_NEAR(mass.volume, 6, 1e-12);
  EXPECT_NEAR(distance(mass.centroid, {1.5, 2, 2.5}), 0, 1e-12);
  EXPECT_NEAR(mass.moments[0], 1.0 / 12, 1e-12);
  EXPECT_NEAR(mass.moments[2], 9.0 / 12, 1e-12);
  EXPECT_NEAR(std::abs(mass.directions[2].z), 1, 1e-12);
}

}  // namespace
}  // namespace symcell::solid
