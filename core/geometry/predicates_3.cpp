#include "core/geometry/predicates_3.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace symcell::internal {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 to_cgal(Point3 p) {
  return {p.x, p.y, p.z};
}

Sign to_sign(CGAL::Sign s) {
  if (s == CGAL::POSITIVE) return Sign::kPositive;
  return s == CGAL::NEGATIVE ? Sign::kNegative : Sign::kZero;
}

}  // namespace

// CGAL goes through its own static filter and interval arithmetic to multi-precision numbers.
Sign orientation_3_exact(Point3 a, Point3 b, Point3 c, Point3 d) {
  return to_sign(Kernel().orientation_3_object()(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d)));
}

Sign in_sphere_exact(Point3 a, Point3 b, Point3 c, Point3 d, Point3 e) {
  return to_sign(Kernel().side_of_oriented_sphere_3_object()(to_cgal(a), to_cgal(b), to_cgal(c),
                                                             to_cgal(d), to_cgal(e)));
}

}  // namespace symcell::internal
