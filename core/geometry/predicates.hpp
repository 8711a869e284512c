// The two predicates all plane geometry branches on; exact for all doubles up to 1e60.
//
// Laws (tests/unit/core/geometry/predicates_test.cpp):
//   1. orientation(a, b, c) = orientation(b, c, a) = -orientation(b, a, c);
//   2. in_circle is even under even permutations of its first three arguments, odd under odd ones;
//   3. in_circle(a, b, c, d) for ccw a, b, c: positive inside, zero on, negative outside the
//   circle;
//   4. the sign is that of the exact determinant: no epsilon, no dependence on the calling order.
// Two stages: an inline filter with a proved bound, then CGAL's exact kernel behind a call. The
// filter decides all but near-degenerate calls, so the call is rare.
//
// The bounds, with u = 2^-53: the differences are one rounding each (and never underflow), so by
// [Shewchuk97] sec. 4 the error is at most (3 + 16u)u * (|left| + |right|) for orientation and
// (10 + 96u)u * permanent for in_circle, barring underflow. Each product that underflows adds at
// most 2^-1074: 2 of them to orientation's determinant; to in_circle's at most 24 * M^2 * 2^-1074
// for differences up to M <= 2e60, below 1e-200. Both are covered by an absolute term.
// REQUIRES: -ffp-contract=off, rounding to nearest, coordinates finite and below kMaxCoordinate.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/geometry/limits.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

enum class Sign : std::int8_t { kNegative = -1, kZero = 0, kPositive = 1 };

[[nodiscard]] constexpr Sign operator-(Sign s) {
  return static_cast<Sign>(-static_cast<std::int8_t>(s));
}

namespace internal {
// u and the bounds derived at the head of this file.
inline constexpr double kUnitRoundoff = 0x1p-53;
inline constexpr double kOrientationBound = (3.0 + 16.0 * kUnitRoundoff) * kUnitRoundoff;
inline constexpr double kInCircleBound = (10.0 + 96.0 * kUnitRoundoff) * kUnitRoundoff;
inline constexpr double kOrientationUnderflow = 1e-300;
inline constexpr double kInCircleUnderflow = 1e-200;

// The exact stages; also for tests, which compare the filters with them.
[[nodiscard]] Sign orientation_exact(Point2 a, Point2 b, Point2 c);
[[nodiscard]] Sign in_circle_exact(Point2 a, Point2 b, Point2 c, Point2 d);

// kZero means "undecided": the filters never prove a zero.
[[nodiscard]] inline Sign decide(double determinant, double bound) {
  if (determinant > bound) return Sign::kPositive;
  if (-determinant > bound) return Sign::kNegative;
  return Sign::kZero;
}

[[nodiscard]] inline Sign orientation_filter(Point2 a, Point2 b, Point2 c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double bound =
      kOrientationBound * (std::abs(left) + std::abs(right)) + kOrientationUnderflow;
  return decide(left - right, bound);
}

[[nodiscard]] inline Sign in_circle_filter(Point2 a, Point2 b, Point2 c, Point2 d) {
  const double adx = a.x - d.x, ady = a.y - d.y;
  const double bdx = b.x - d.x, bdy = b.y - d.y;
  const double cdx = c.x - d.x, cdy = c.y - d.y;
  const double bc = bdx * cdy, cb = cdx * bdy;
  const double ca = cdx * ady, ac = adx * cdy;
  const double ab = adx * bdy, ba = bdx * ady;
  const double a_lift = adx * adx + ady * ady;
  const double b_lift = bdx * bdx + bdy * bdy;
  const double c_lift = cdx * cdx + cdy * cdy;
  const double determinant = a_lift * (bc - cb) + b_lift * (ca - ac) + c_lift * (ab - ba);
  const double permanent = (std::abs(bc) + std::abs(cb)) * a_lift +
                           (std::abs(ca) + std::abs(ac)) * b_lift +
                           (std::abs(ab) + std::abs(ba)) * c_lift;
  return decide(determinant, kInCircleBound * permanent + kInCircleUnderflow);
}

}  // namespace internal

// Positive if a, b, c make a left turn, zero if they are collinear.
[[nodiscard]] inline Sign orientation(Point2 a, Point2 b, Point2 c) {
  const Sign s = internal::orientation_filter(a, b, c);
  return s != Sign::kZero ? s : internal::orientation_exact(a, b, c);
}

// Positive if d lies inside the circle through a, b, c in counter-clockwise order.
[[nodiscard]] inline Sign in_circle(Point2 a, Point2 b, Point2 c, Point2 d) {
  const Sign s = internal::in_circle_filter(a, b, c, d);
  return s != Sign::kZero ? s : internal::in_circle_exact(a, b, c, d);
}

}  // namespace symcell
