// Predicates of space over copies of vertices (orbit, exponent); as the plane's lifted_predicates.hpp: exact
// where all corners have one exponent, elsewhere certain or kZero, "equal within rounding". Every
// non-zero sign is true of the exact rotations, for every choice of representatives.
//
// Error bounds, u = 2^-53: a lifted point is off by at most 5u times its distance from the axis, so
// a difference of two by d = 10uR with R the largest such distance; z is not rounded. With L the
// diagonal of the points' box, an orientation moves by at most 3 L^2 d; in_sphere, four terms of a
// squared length and a triple product, by 4 (2 L d L^3 + L^2 3 L^2 d) = 20 L^4 d. The filter's own
// rounding: the permanent of three vectors of length L is at most 2/sqrt(3) L^3
// [Carlen-Lieb-Loss06], so 9u L^3 and 75u L^5. The constants below round these up.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/predicates_3.hpp"
#include "core/solid/quotient/quotient_tetrahedralization.hpp"

namespace symcell::solid {

namespace internal {
// At least 30u R L^2 and 9u L^3 of an orientation, 200u R L^4 and 75u L^5 of in_sphere.
inline constexpr double kLiftOrientation3Radius = 32.0 * symcell::internal::kUnitRoundoff;
inline constexpr double kLiftOrientation3Length = 12.0 * symcell::internal::kUnitRoundoff;
inline constexpr double kLiftInSphereRadius = 256.0 * symcell::internal::kUnitRoundoff;
inline constexpr double kLiftInSphereLength = 96.0 * symcell::internal::kUnitRoundoff;

struct LiftedExtent {
  double radius = 0;  // bound on the distance from the axis
  double length = 0;  // bound on the distance of two points
};

template <std::size_t N>
[[nodiscard]] inline LiftedExtent lifted_extent(const std::array<Point3, N>& points) {
  Point3 low = points[0], high = points[0];
  double radius = 0;
  for (const Point3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    radius = std::max(radius, std::abs(p.x) + std::abs(p.y));
  }
  return {radius, (high.x - low.x) + (high.y - low.y) + (high.z - low.z)};
}

// Whether the corners off the axis share one exponent.
template <class... Corners>
[[nodiscard]] inline bool one_sheet(const QuotientTetrahedralization& mesh,
                                    const Corners&... corners) {
  std::int32_t k = -1;
  bool same = true;
  const auto look = [&](const OrbitVertex& c) {
    if (mesh.on_axis(c.orbit)) return;
    if (k < 0) {
      k = c.exponent;
    } else if (k != c.exponent) {
      same = false;
    }
  };
  (look(corners), ...);
  return same;
}

}  // namespace internal

// Signs for points known up to the rounding of their lifts. `slack`: factor on the bound, for
// checks that must not call certain what was left alone as uncertain before with other roundings.
[[nodiscard]] inline Sign certain_orientation_3(
    Point3 a, Point3 b, Point3 c, Point3 d, double slack = 1) {
  const auto size = internal::lifted_extent(std::array{a, b, c, d});
  const double bound = size.length * size.length *
                       (internal::kLiftOrientation3Radius * size.radius +
                        internal::kLiftOrientation3Length * size.length);
  return symcell::internal::decide(-symcell::internal::orientation_3_determinant(a, b, c, d).value,
                                   slack * bound);
}

[[nodiscard]] inline Sign certain_in_sphere(
    Point3 a, Point3 b, Point3 c, Point3 d, Point3 e, double slack = 1) {
  const auto size = internal::lifted_extent(std::array{a, b, c, d, e});
  const double square = size.length * size.length;
  const double bound =
      square * square *
      (internal::kLiftInSphereRadius * size.radius + internal::kLiftInSphereLength * size.length);
  return symcell::internal::decide(-symcell::internal::in_sphere_determinant(a, b, c, d, e).value,
                                   slack * bound);
}

[[nodiscard]] inline Sign orientation_3(const QuotientTetrahedralization& mesh,
                                        OrbitVertex a,
                                        OrbitVertex b,
                                        OrbitVertex c,
                                        OrbitVertex d) {
  if (internal::one_sheet(mesh, a, b, c, d)) {
    return orientation_3(mesh.point(a.orbit), mesh.point(b.orbit), mesh.point(c.orbit),
                         mesh.point(d.orbit));
  }
  return certain_orientation_3(mesh.lift(a), mesh.lift(b), mesh.lift(c), mesh.lift(d));
}

[[nodiscard]] inline Sign in_sphere(const QuotientTetrahedralization& mesh,
                                    OrbitVertex a,
                                    OrbitVertex b,
                                    OrbitVertex c,
                                    OrbitVertex d,
                                    OrbitVertex e,
                                    double slack = 1) {
  if (internal::one_sheet(mesh, a, b, c, d, e)) {
    return in_sphere(mesh.point(a.orbit), mesh.point(b.orbit), mesh.point(c.orbit),
                     mesh.point(d.orbit), mesh.point(e.orbit));
  }
  return certain_in_sphere(mesh.lift(a), mesh.lift(b), mesh.lift(c), mesh.lift(d), mesh.lift(e),
                           slack);
}

}  // namespace symcell::solid
