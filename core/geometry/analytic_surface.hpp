// The surfaces that nearly all faces of parts lie on.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/geometry/point.hpp"

namespace symcell {

enum class FaceKind : std::uint8_t { kPlane, kCylinder, kCone, kSphere, kTorus, kSurface };

// "plane", ...; "surface": none of the others with certainty.
[[nodiscard]] constexpr std::string_view face_kind_name(FaceKind kind) {
  switch (kind) {
    case FaceKind::kPlane: return "plane";
    case FaceKind::kCylinder: return "cylinder";
    case FaceKind::kCone: return "cone";
    case FaceKind::kSphere: return "sphere";
    case FaceKind::kTorus: return "torus";
    case FaceKind::kSurface: break;
  }
  return "surface";
}

struct AnalyticSurface {
  FaceKind kind = FaceKind::kSurface;
  Point3 origin;      // of the axis; of a sphere the centre, of a plane a point
  Point3 direction;   // of the axis, of length 1; of a plane the normal; of a cone to its wide end
  double radius = 0;  // of a cylinder, sphere or torus about its axis
  double tube_radius = 0;  // of a torus
  double half_angle = 0;   // of a cone, radians
  Point3 apex;             // of a cone
};

// The point of the surface that is nearest to p; p itself for a kind without one. Where many are as near, on the
// axis, in the centre or the tube's middle, it is one of them.
[[nodiscard]] Point3 project_onto(const AnalyticSurface& surface, Point3 p);

// The normal of the surface near p, away from its axis, centre or tube, of length 1; of a plane its own.
// Requires: a kind that has one.
[[nodiscard]] Point3 normal_at(const AnalyticSurface& surface, Point3 p);

}  // namespace symcell
