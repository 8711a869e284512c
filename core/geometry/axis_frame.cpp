#include "core/geometry/axis_frame.hpp"

#include <cmath>

#include "core/base/assert.hpp"

namespace symcell {

AxisFrame AxisFrame::of_axis(Point3 origin, Point3 direction) {
  const double norm = length(direction);
  SYMCELL_ASSERT(norm > 0);
  const Point3 w = (1 / norm) * direction;
  // The coordinate axis least along w, made normal to it, is the first axis of the frame.
  const double ax = std::abs(w.x), ay = std::abs(w.y), az = std::abs(w.z);
  Point3 seed{1, 0, 0};
  if (ay < ax && ay <= az) seed = {0, 1, 0};
  if (az < ax && az < ay) seed = {0, 0, 1};
  Point3 u = seed - dot(seed, w) * w;
  u = (1 / length(u)) * u;
  const Point3 v = cross(w, u);
  AxisFrame frame;
  frame.origin = origin;
  frame.matrix = {u.x, v.x, w.x, u.y, v.y, w.y, u.z, v.z, w.z};
  return frame;
}

}  // namespace symcell
