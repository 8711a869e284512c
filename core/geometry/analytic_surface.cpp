#include "core/geometry/analytic_surface.hpp"

#include <cmath>

namespace symcell {
namespace {

Point3 unit(Point3 p) {
  return (1 / length(p)) * p;
}

}  // namespace

Point3 project_onto(const AnalyticSurface& surface, Point3 p) {
  const Point3 d = p - surface.origin;
  const Point3 along = dot(d, surface.direction) * surface.direction;
  const Point3 across = d - along;
  switch (surface.kind) {
    case FaceKind::kPlane: return p - along;
    case FaceKind::kCylinder: return surface.origin + along + surface.radius * unit(across);
    case FaceKind::kSphere: return surface.origin + surface.radius * unit(d);
    case FaceKind::kTorus: {
      const Point3 ring = surface.origin + surface.radius * unit(across);
      return ring + surface.tube_radius * unit(p - ring);
    }
    case FaceKind::kCone: {
      const Point3 ray = std::cos(surface.half_angle) * surface.direction +
                         std::sin(surface.half_angle) * unit(across);
      return surface.apex + dot(p - surface.apex, ray) * ray;
    }
    case FaceKind::kSurface: break;
  }
  return p;
}

Point3 normal_at(const AnalyticSurface& surface, Point3 p) {
  const Point3 d = p - surface.origin;
  const Point3 across = d - dot(d, surface.direction) * surface.direction;
  switch (surface.kind) {
    case FaceKind::kPlane: return surface.direction;
    case FaceKind::kSphere: return unit(d);
    case FaceKind::kTorus: return unit(p - (surface.origin + surface.radius * unit(across)));
    case FaceKind::kCone:
      return std::cos(surface.half_angle) * unit(across) -
             std::sin(surface.half_angle) * surface.direction;
    default: return unit(across);
  }
}

}  // namespace symcell
