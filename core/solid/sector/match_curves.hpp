// Which points of one polyline are which of another that runs nearly the same way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell::solid {

// One point of the common curve: a vertex of either, or of both.
struct CurveMatch {
  std::int32_t a = -1;  // index in the first polyline, -1: within its edge before the next match
  std::int32_t b = -1;  // the same of the second
};

// The union of the vertices of two polylines in an order that both keep: the first and the last
// points match, between them the sum of squared distances is least (a vertex that has no partner
// counts its distance to the other's edge, and `lone_cost` squared more).
// Empty if the table would be too large.  Cost: O(a * b) time and bytes.
[[nodiscard]] std::vector<CurveMatch> match_curves(std::span<const Point2> a,
                                                   std::span<const Point2> b,
                                                   double lone_cost);

// The largest distance of a vertex of one polyline from the other, both ways.  Cost: O(a * b).
[[nodiscard]] double curve_distance(std::span<const Point2> a, std::span<const Point2> b);

}  // namespace symcell::solid
