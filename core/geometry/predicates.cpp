#include "core/geometry/predicates.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace symcell::internal {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 to_cgal(Point2 p) {
  return {p.x, p.y};
}

Sign to_sign(CGAL::Sign s) {
  if (s == CGAL::POSITIVE) return Sign::kPositive;
  return s == CGAL::NEGATIVE ? Sign::kNegative : Sign::kZero;
}

}  // namespace

// CGAL goes through its own static filter and interval arithmetic to multi-precision numbers.
Sign orientation_exact(Point2 a, Point2 b, Point2 c) {
  return to_sign(Kernel().orientation_2_object()(to_cgal(a), to_cgal(b), to_cgal(c)));
}

Sign in_circle_exact(Point2 a, Point2 b, Point2 c, Point2 d) {
  return to_sign(
      Kernel().side_of_oriented_circle_2_object()(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d)));
}

}  // namespace symcell::internal
