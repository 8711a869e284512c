#include "core/geometry/analytic_surface.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/axis_frame.hpp"

namespace symcell {
namespace {

// Of a vector that is rounding alone less than so much is left of length 1 when it is made normal to the axis
// again.
constexpr double kLeastLeft = 0.5;

// One of the directions at right angles to `axis`, which may be of no length.
Point3 any_normal_to(Point3 axis) {
  if (!(length(axis) > 0)) return {1, 0, 0};
  return AxisFrame::of_axis({0, 0, 0}, axis).to_model({1, 0, 0});
}

// Of length 1, along d; where d is nothing every direction is as good, and one normal to `axis` is taken.
Point3 unit(Point3 d, Point3 axis) {
  const double size = length(d);
  return size > 0 ? (1 / size) * d : any_normal_to(axis);
}

// Of length 1, from the axis to a place at d from a point of it; on the axis any that is normal to it.
Point3 away_from(Point3 axis, Point3 d) {
  const Point3 across = d - dot(d, axis) * axis;
  const double size = length(across);
  if (!(size > 0)) return any_normal_to(axis);
  const Point3 out = (1 / size) * across;
  const Point3 left = out - dot(out, axis) * axis;
  const double rest = length(left);
  return rest > kLeastLeft ? (1 / rest) * left : any_normal_to(axis);
}

// Of length 1, from the ring in a torus's tube that lies in direction `out` to a place at d from the torus's centre; on
// the ring `out`, which is as good as any.
Point3 away_from_ring(const AnalyticSurface& torus, Point3 out, Point3 d) {
  const double r = dot(d, out) - torus.radius, z = dot(d, torus.direction);
  const double size = std::hypot(r, z);
  return size > 0 ? (r / size) * out + (z / size) * torus.direction : out;
}

}  // namespace

Point3 project_onto(const AnalyticSurface& surface, Point3 p) {
  const Point3& axis = surface.direction;
  const Point3 d = p - surface.origin;
  const Point3 along = dot(d, axis) * axis;
  switch (surface.kind) {
    case FaceKind::kPlane: return p - along;
    case FaceKind::kCylinder: return surface.origin + along + surface.radius * away_from(axis, d);
    case FaceKind::kSphere: return surface.origin + surface.radius * unit(d, axis);
    case FaceKind::kTorus: {
      const Point3 out = away_from(axis, d);
      return surface.origin + surface.radius * out +
             surface.tube_radius * away_from_ring(surface, out, d);
    }
    case FaceKind::kCone: {
      const Point3 ray =
          std::cos(surface.half_angle) * axis + std::sin(surface.half_angle) * away_from(axis, d);
      // Behind the apex the apex is nearest.
      return surface.apex + std::max(0.0, dot(p - surface.apex, ray)) * ray;
    }
    case FaceKind::kSurface: break;
  }
  return p;
}

Point3 normal_at(const AnalyticSurface& surface, Point3 p) {
  const Point3& axis = surface.direction;
  const Point3 d = p - surface.origin;
  switch (surface.kind) {
    case FaceKind::kPlane: return axis;
    case FaceKind::kSphere: return unit(d, axis);
    case FaceKind::kTorus: return away_from_ring(surface, away_from(axis, d), d);
    case FaceKind::kCone:
      return std::cos(surface.half_angle) * away_from(axis, d) -
             std::sin(surface.half_angle) * axis;
    default: return away_from(axis, d);
  }
}

}  // namespace symcell
