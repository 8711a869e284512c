// Laws of the nearest point of a surface and of the normal there, at places that are beside it, on it, and where
// every direction is as near.
#include "core/geometry/analytic_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/random.hpp"

namespace symcell {
namespace {

std::vector<AnalyticSurface> surfaces() {
  std::vector<AnalyticSurface> all;
  for (const FaceKind kind : {FaceKind::kPlane, FaceKind::kCylinder, FaceKind::kCone,
                              FaceKind::kSphere, FaceKind::kTorus}) {
    for (const Point3 direction : {Point3{0, 0, 1}, Point3{1.0 / 3, 2.0 / 3, -2.0 / 3}}) {
      AnalyticSurface s;
      s.kind = kind;
      s.origin = {3, -1, 2};
      s.direction = direction;
      s.radius = 2;
      s.tube_radius = 0.5;
      s.half_angle = 0.4;
      s.apex = s.origin + 1.5 * direction;
      if (kind == FaceKind::kSphere) s.direction = {0, 0, 0};
      all.push_back(s);
    }
  }
  return all;
}

void expect_on_surface(const AnalyticSurface& s, Point3 p) {
  const Point3 q = project_onto(s, p);
  ASSERT_TRUE(std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z))
      << face_kind_name(s.kind);
  EXPECT_LT(distance(project_onto(s, q), q), 1e-12) << face_kind_name(s.kind);
  EXPECT_NEAR(length(normal_at(s, p)), 1, 1e-12) << face_kind_name(s.kind);
}

TEST(AnalyticSurface, EveryPlaceHasANearestPointAndANormal) {
  Random random(5);
  for (const AnalyticSurface& s : surfaces()) {
    for (int i = 0; i < 200; ++i) {
      expect_on_surface(s, s.origin + Point3{6 * random.uniform() - 3, 6 * random.uniform() - 3,
                                             6 * random.uniform() - 3});
    }
    // On the axis, at the centre, the apex, and behind it.
    for (const double along : {0.0, 1.5, -4.0, 1.0, 4.0}) {
      expect_on_surface(s, s.origin + along * s.direction);
    }
    expect_on_surface(s, s.apex);
  }
  // In the middle of a torus's tube.
  AnalyticSurface torus = surfaces()[8];
  ASSERT_EQ(torus.kind, FaceKind::kTorus);
  expect_on_surface(torus, torus.origin + Point3{torus.radius, 0, 0});
}

TEST(AnalyticSurface, AnApexIsOnItsConeAndNearestToWhatIsBehindIt) {
  AnalyticSurface cone = surfaces()[4];
  ASSERT_EQ(cone.kind, FaceKind::kCone);
  EXPECT_LT(distance(project_onto(cone, cone.apex), cone.apex), 1e-15);
  const Point3 behind = cone.apex - 2 * cone.direction;
  EXPECT_LT(distance(project_onto(cone, behind), cone.apex), 1e-15);
}

}  // namespace
}  // namespace symcell
