// Which simple surface a face is a tessellation of.
//
// Vertices of a tessellation lie on the true surface, its triangles beside it: the vertices are
// fitted, by least squares that are linear in the unknowns, and normals of triangles are asked
// whether they agree. A face that is none of the kinds within the tolerance is none of them:
// nothing is called by a kind for being near to it.
#pragma once

#include <vector>

#include "core/cell/face_group.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/point.hpp"

namespace symcell::solid {

struct ShapeFit {
  FaceKind kind = FaceKind::kSurface;
  Point3 origin;           // of the axis; of a sphere the centre, of a plane the centroid
  Point3 direction;        // of the axis, of length 1; of a plane the normal, outwards
  double radius = 0;       // of a cylinder, sphere or torus about its axis; largest of a cone
  double tube_radius = 0;  // of a torus
  double half_angle = 0;   // of a cone, radians
  Point3 apex;             // of a cone
  bool concave = false;    // the material is outside of it
  bool closes = false;     // goes round its axis without a wide gap
};

// The point of the fitted surface that is nearest to p; p itself for a kind without one.
[[nodiscard]] Point3 project_onto(const ShapeFit& fit, Point3 p);

// `triangles`: of one face. `noise`: of the coordinates. The z axis is the first that is tried.
// Cost: O(T).
[[nodiscard]] ShapeFit fit_shape(const IndexedSurface& surface,
                                 const std::vector<std::int32_t>& triangles,
                                 double noise);

}  // namespace symcell::solid
