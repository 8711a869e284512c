// Predicates over copies of vertices (orbit, exponent).
//
// If all corners have one exponent their common rotation is dropped and the sign is exact. Else the
// points are lifted, which rounds, and the sign is returned only where it is certain for the exact
// rotations; kZero means "equal within rounding". So every non-zero sign is true, for every choice
// of representatives, and a flip made on a positive in-circle sign strictly lowers the lifted
// surface of the true positions: no flip loop is possible.
//
// Error bounds, u = 2^-53: a lifted point is off by at most 5u|p| (table, products, sum), a
// difference of two by 10uR with R the largest radius. With L the largest difference the in-circle
// determinant moves by at most 12 L^3 times that, and the filter's own rounding adds 60u L^4; an
// orientation moves by 2L times that plus 4u L^2. The constants below round these up.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/predicates.hpp"
#include "core/plane/quotient/quotient_triangulation.hpp"

namespace symcell::plane {

namespace internal {
inline constexpr double kLiftInCircleRadius = 128.0 * symcell::internal::kUnitRoundoff;    // 120u
inline constexpr double kLiftInCircleLength = 64.0 * symcell::internal::kUnitRoundoff;     // 60u
inline constexpr double kLiftOrientationRadius = 24.0 * symcell::internal::kUnitRoundoff;  // 20u
inline constexpr double kLiftOrientationLength = 8.0 * symcell::internal::kUnitRoundoff;   // 4u

[[nodiscard]] inline double radius_bound(Point2 p) {
  return std::abs(p.x) + std::abs(p.y);
}
}  // namespace internal

// `radius`: bound on the distance of the points from the centre.  Sign for points known up to
// the rounding of their lifts.
[[nodiscard]] inline Sign certain_orientation(Point2 a, Point2 b, Point2 c, double radius) {
  const Point2 ac = a - c, bc = b - c;
  const double extent = std::max(internal::radius_bound(ac), internal::radius_bound(bc));
  const double bound = extent * (internal::kLiftOrientationRadius * radius +
                                 internal::kLiftOrientationLength * extent);
  return symcell::internal::decide(cross(ac, bc), bound);
}

// The bound is the same whichever of the points is d. `slack`: factor on it, for checks that must
// not call certain what was left alone as uncertain before with other roundings.
[[nodiscard]] inline Sign certain_in_circle(
    Point2 a, Point2 b, Point2 c, Point2 d, double radius, double slack = 1) {
  const Point2 ad = a - d, bd = b - d, cd = c - d;
  const double extent = std::max({a.x, b.x, c.x, d.x}) - std::min({a.x, b.x, c.x, d.x}) +
                        std::max({a.y, b.y, c.y, d.y}) - std::min({a.y, b.y, c.y, d.y});
  const double determinant = squared_length(ad) * cross(bd, cd) +
                             squared_length(bd) * cross(cd, ad) +
                             squared_length(cd) * cross(ad, bd);
  const double bound =
      extent * extent * extent *
      (internal::kLiftInCircleRadius * radius + internal::kLiftInCircleLength * extent);
  return symcell::internal::decide(determinant, slack * bound);
}

namespace internal {

// The exponent that all corners but the centre's share, or -1.
template <class... Corners>
[[nodiscard]] inline bool one_sheet(const QuotientTriangulation& mesh, const Corners&... corners) {
  std::int32_t k = -1;
  bool same = true;
  const auto look = [&](const OrbitVertex& c) {
    if (c.orbit == mesh.centre()) return;
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

[[nodiscard]] inline Sign orientation(const QuotientTriangulation& mesh,
                                      OrbitVertex a,
                                      OrbitVertex b,
                                      OrbitVertex c) {
  if (internal::one_sheet(mesh, a, b, c)) {
    return orientation(mesh.point(a.orbit), mesh.point(b.orbit), mesh.point(c.orbit));
  }
  const Point2 p = mesh.lift(a.orbit, a.exponent), q = mesh.lift(b.orbit, b.exponent),
               r = mesh.lift(c.orbit, c.exponent);
  return certain_orientation(
      p, q, r,
      std::max({internal::radius_bound(p), internal::radius_bound(q), internal::radius_bound(r)}));
}

[[nodiscard]] inline Sign in_circle(const QuotientTriangulation& mesh,
                                    OrbitVertex a,
                                    OrbitVertex b,
                                    OrbitVertex c,
                                    OrbitVertex d,
                                    double slack = 1) {
  if (internal::one_sheet(mesh, a, b, c, d)) {
    return in_circle(mesh.point(a.orbit), mesh.point(b.orbit), mesh.point(c.orbit),
                     mesh.point(d.orbit));
  }
  const Point2 p = mesh.lift(a.orbit, a.exponent), q = mesh.lift(b.orbit, b.exponent);
  const Point2 r = mesh.lift(c.orbit, c.exponent), s = mesh.lift(d.orbit, d.exponent);
  return certain_in_circle(p, q, r, s,
                           std::max({internal::radius_bound(p), internal::radius_bound(q),
                                     internal::radius_bound(r), internal::radius_bound(s)}),
                           slack);
}

}  // namespace symcell::plane
