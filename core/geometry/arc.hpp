// Circular arcs by their ends and their bulge, the tangent of a quarter of the angle that an arc
// turns by from a to b: positive if counter-clockwise, 0 for a straight line, 1 for half a circle.
// The bulge does not change with the place, size or orientation of the arc and changes sign where
// the ends are swapped, so that copies of an arc have one. Source: DXF's polylines.
//
// No function goes by the arc's centre, which is far away where the arc is nearly straight.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/point.hpp"

namespace symcell {

// Angles in radians.
[[nodiscard]] inline double bulge_of_angle(double angle) {
  return std::tan(angle / 4);
}
[[nodiscard]] inline double angle_of_bulge(double bulge) {
  return 4 * std::atan(bulge);
}

[[nodiscard]] inline Point2 turned(Point2 v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

// The point at a share of the arc's length from a.  Requires: a != b, |bulge| finite.
[[nodiscard]] inline Point2 arc_point(Point2 a, Point2 b, double bulge, double share) {
  if (bulge == 0) return a + share * (b - a);
  // The chord from a to the point turns from the tangent at a by half of the angle in between.
  const double angle = angle_of_bulge(bulge);
  const double ratio = std::sin(share * angle / 2) / std::sin(angle / 2);
  return a + ratio * turned(b - a, (share - 1) * angle / 2);
}

[[nodiscard]] inline Point2 arc_middle(Point2 a, Point2 b, double bulge) {
  const Point2 d = b - a;
  return a + 0.5 * d + 0.5 * bulge * Point2{d.y, -d.x};
}

// Requires: bulge != 0.
[[nodiscard]] inline Point2 arc_centre(Point2 a, Point2 b, double bulge) {
  const Point2 d = b - a;
  return a + 0.5 * d + (1 - bulge * bulge) / (4 * bulge) * Point2{-d.y, d.x};
}
[[nodiscard]] inline double arc_radius(Point2 a, Point2 b, double bulge) {
  return distance(a, b) * (1 + bulge * bulge) / (4 * std::abs(bulge));
}

// Of the arc from a to b about a centre, counter-clockwise, in (0, 2 pi); the centre is taken to be
// as far from both.
[[nodiscard]] inline double bulge_about(Point2 a, Point2 b, Point2 centre) {
  const Point2 u = a - centre, v = b - centre;
  double angle = std::atan2(cross(u, v), dot(u, v));
  if (!(angle > 0)) angle += 2 * std::numbers::pi;
  return bulge_of_angle(angle);
}

// The angle by which chords of an arc may turn: their middles lie off it by `error_rel` of the
// radius at most, and they are no longer than `longest`.
[[nodiscard]] inline double widest_chord(double radius, double error_rel, double longest) {
  const double angle = 2 * std::acos(1 - error_rel);
  return longest < 2 * radius ? std::min(angle, 2 * std::asin(longest / (2 * radius))) : angle;
}

}  // namespace symcell
