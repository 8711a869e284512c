// Groups of the faces of a surface that came without any: what `symcell inspect` lists, and what a
// cell's boundary facets are marked with.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/geometry/analytic_surface.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

struct FaceGroup {
  std::int32_t marker = 0;  // its number, from 1
  std::string name;         // no two groups have one name
  FaceKind kind = FaceKind::kSurface;
  std::int32_t faces = 0;  // pieces in the whole model that hang together
  double area = 0;         // of all of them, input units squared
  Point3 centroid;         // of all of them
  Point3 point;            // on one of the faces
  // Of one of the faces: a point of the axis and its direction, a sphere's centre.
  std::optional<Point3> axis_origin;
  std::optional<Point3> axis_direction;
  std::optional<Point3> normal;  // of a plane, outwards
  // Input units: of a cylinder or sphere; of a torus about its axis, of a cone the largest.
  std::optional<double> radius;
  std::optional<double> tube_radius;     // of a torus
  std::optional<double> half_angle_deg;  // of a cone
  bool concave = false;                  // the material is outside: a hole, a hollow
  std::int32_t colour = -1;              // 0xRRGGBB, of a CAD face that has one
};

}  // namespace symcell
