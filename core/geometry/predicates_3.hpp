// The two predicates all geometry of space branches on; exact for all doubles up to 1e60.
//
// Laws (tests/unit/core/geometry/predicates_3_test.cpp):
//   1. orientation_3 is even under even permutations of its arguments, odd under odd ones;
//   2. orientation_3(a, b, c, d) > 0: a tetrahedron in VTK's order, (b - a) x (c - a) . (d - a) >
//   0;
//   3. in_sphere is even under even permutations of its first four arguments, odd under odd ones;
//   4. in_sphere(a, b, c, d, e) for positively oriented a, b, c, d: positive inside, zero on,
//      negative outside the sphere;
//   5. the sign is that of the exact determinant: no epsilon, no dependence on the calling order.
// Two stages, as in predicates.hpp: an inline filter with a proved bound, then CGAL's exact kernel.
//
// The bounds, with u = 2^-53: by [Shewchuk97] sec. 4 the error of the expressions below is at most
// (7 + 56u)u * permanent for orientation_3 and (16 + 224u)u * permanent for in_sphere, barring
// underflow. A product that underflows is off by at most 2^-1074 and then multiplied by what stands
// outside it, at most M = 2e60 in orientation_3 (12 of them: below 1e-260) and M * 3 M^2 in
// in_sphere (below 100 of them: 1e-138). Both are covered by an absolute term.
// REQUIRES: -ffp-contract=off, rounding to nearest, coordinates finite and below 1e60.
#pragma once

#include <cmath>

#include "core/geometry/point.hpp"
#include "core/geometry/predicates.hpp"

namespace symcell {

namespace internal {
// The bounds derived at the head of this file.
inline constexpr double kOrientation3Bound = (7.0 + 56.0 * kUnitRoundoff) * kUnitRoundoff;
inline constexpr double kInSphereBound = (16.0 + 224.0 * kUnitRoundoff) * kUnitRoundoff;
inline constexpr double kOrientation3Underflow = 1e-260;
inline constexpr double kInSphereUnderflow = 1e-138;

// The exact stages; also for tests, which compare the filters with them.
[[nodiscard]] Sign orientation_3_exact(Point3 a, Point3 b, Point3 c, Point3 d);
[[nodiscard]] Sign in_sphere_exact(Point3 a, Point3 b, Point3 c, Point3 d, Point3 e);

// A determinant with the sum of the absolute values of its terms.
struct Determinant {
  double value;
  double permanent;
};

// Of the rows a - d, b - d, c - d: negative for a tetrahedron in VTK's order.
[[nodiscard]] inline Determinant orientation_3_determinant(Point3 a, Point3 b, Point3 c, Point3 d) {
  const Point3 ad = a - d, bd = b - d, cd = c - d;
  const double bc = bd.x * cd.y, cb = cd.x * bd.y;
  const double ca = cd.x * ad.y, ac = ad.x * cd.y;
  const double ab = ad.x * bd.y, ba = bd.x * ad.y;
  return {ad.z * (bc - cb) + bd.z * (ca - ac) + cd.z * (ab - ba),
          (std::abs(bc) + std::abs(cb)) * std::abs(ad.z) +
              (std::abs(ca) + std::abs(ac)) * std::abs(bd.z) +
              (std::abs(ab) + std::abs(ba)) * std::abs(cd.z)};
}

// Of the rows (a - e, |a - e|^2) ...: negative inside for a tetrahedron in VTK's order.
[[nodiscard]] inline Determinant in_sphere_determinant(
    Point3 a, Point3 b, Point3 c, Point3 d, Point3 e) {
  const Point3 ae = a - e, be = b - e, ce = c - e, de = d - e;
  const double axby = ae.x * be.y, bxay = be.x * ae.y, ab = axby - bxay;
  const double bxcy = be.x * ce.y, cxby = ce.x * be.y, bc = bxcy - cxby;
  const double cxdy = ce.x * de.y, dxcy = de.x * ce.y, cd = cxdy - dxcy;
  const double dxay = de.x * ae.y, axdy = ae.x * de.y, da = dxay - axdy;
  const double axcy = ae.x * ce.y, cxay = ce.x * ae.y, ac = axcy - cxay;
  const double bxdy = be.x * de.y, dxby = de.x * be.y, bd = bxdy - dxby;
  const double abc = ae.z * bc - be.z * ac + ce.z * ab;
  const double bcd = be.z * cd - ce.z * bd + de.z * bc;
  const double cda = ce.z * da + de.z * ac + ae.z * cd;
  const double dab = de.z * ab + ae.z * bd + be.z * da;
  const double a2 = squared_length(ae), b2 = squared_length(be);
  const double c2 = squared_length(ce), d2 = squared_length(de);
  const double az = std::abs(ae.z), bz = std::abs(be.z), cz = std::abs(ce.z), dz = std::abs(de.z);
  const double ab_size = std::abs(axby) + std::abs(bxay), bc_size = std::abs(bxcy) + std::abs(cxby);
  const double cd_size = std::abs(cxdy) + std::abs(dxcy), da_size = std::abs(dxay) + std::abs(axdy);
  const double ac_size = std::abs(axcy) + std::abs(cxay), bd_size = std::abs(bxdy) + std::abs(dxby);
  return {(d2 * abc - c2 * dab) + (b2 * cda - a2 * bcd),
          (cd_size * bz + bd_size * cz + bc_size * dz) * a2 +
              (da_size * cz + ac_size * dz + cd_size * az) * b2 +
              (ab_size * dz + bd_size * az + da_size * bz) * c2 +
              (bc_size * az + ac_size * bz + ab_size * cz) * d2};
}

[[nodiscard]] inline Sign orientation_3_filter(Point3 a, Point3 b, Point3 c, Point3 d) {
  const Determinant det = orientation_3_determinant(a, b, c, d);
  return decide(-det.value, kOrientation3Bound * det.permanent + kOrientation3Underflow);
}

[[nodiscard]] inline Sign in_sphere_filter(Point3 a, Point3 b, Point3 c, Point3 d, Point3 e) {
  const Determinant det = in_sphere_determinant(a, b, c, d, e);
  return decide(-det.value, kInSphereBound * det.permanent + kInSphereUnderflow);
}

}  // namespace internal

// Positive if a, b, c turn counter-clockwise seen from d's side, zero if the four are coplanar.
[[nodiscard]] inline Sign orientation_3(Point3 a, Point3 b, Point3 c, Point3 d) {
  const Sign s = internal::orientation_3_filter(a, b, c, d);
  return s != Sign::kZero ? s : internal::orientation_3_exact(a, b, c, d);
}

// Positive if e lies inside the sphere through the positively oriented a, b, c, d.
[[nodiscard]] inline Sign in_sphere(Point3 a, Point3 b, Point3 c, Point3 d, Point3 e) {
  const Sign s = internal::in_sphere_filter(a, b, c, d, e);
  return s != Sign::kZero ? s : internal::in_sphere_exact(a, b, c, d, e);
}

}  // namespace symcell
