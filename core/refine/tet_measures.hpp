// Measures of one tetrahedron from its four corners' positions, positively oriented.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/geometry/point.hpp"

namespace symcell {

[[nodiscard]] inline double six_volumes(Point3 a, Point3 b, Point3 c, Point3 d) {
  return dot(cross(b - a, c - a), d - a);
}

struct TetMeasures {
  Point3 centre;         // of the circumscribed sphere
  double radius2 = 0;    // its radius squared; inf for a flat tetrahedron
  double shortest2 = 0;  // edges, squared
  double longest2 = 0;
  double volume = 0;  // signed

  // Circumradius / shortest edge, squared.
  [[nodiscard]] double ratio2() const { return radius2 / shortest2; }
};

[[nodiscard]] inline TetMeasures measure_tet(Point3 a, Point3 b, Point3 c, Point3 d) {
  const Point3 u = b - a, v = c - a, w = d - a;
  const Point3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double det = dot(u, vw);
  const double uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
  const double bc = squared_distance(b, c), bd = squared_distance(b, d),
               cd = squared_distance(c, d);
  TetMeasures m;
  m.volume = det / 6;
  m.shortest2 = std::min({uu, vv, ww, bc, bd, cd});
  m.longest2 = std::max({uu, vv, ww, bc, bd, cd});
  if (det == 0) {
    m.centre = 0.25 * (a + b + c + d);
    m.radius2 = std::numeric_limits<double>::infinity();
    return m;
  }
  const Point3 r = (0.5 / det) * (uu * vw + vv * wu + ww * uv);
  m.centre = a + r;
  m.radius2 = dot(r, r);
  return m;
}

// The smallest sine among the six dihedral angles: small for slivers with angles near 0 and near
// 180 degrees alike; negative if the tetrahedron is inverted. Source: [KlingnerShewchuk07].
[[nodiscard]] inline double min_dihedral_sine(Point3 a, Point3 b, Point3 c, Point3 d) {
  // Normals of faces 0..3, outward for a positive tetrahedron.
  const Point3 n0 = cross(c - b, d - b), n1 = cross(d - a, c - a), n2 = cross(b - a, d - a),
               n3 = cross(c - a, b - a);
  const double volume6 = six_volumes(a, b, c, d);
  const double s0 = dot(n0, n0), s1 = dot(n1, n1), s2 = dot(n2, n2), s3 = dot(n3, n3);
  // sin(angle at edge e between faces i, j) = 6 V |e| / (|n_i| |n_j|).
  const double worst2 =
      std::min({squared_distance(a, b) / (s2 * s3), squared_distance(a, c) / (s1 * s3),
                squared_distance(a, d) / (s1 * s2), squared_distance(b, c) / (s0 * s3),
                squared_distance(b, d) / (s0 * s2), squared_distance(c, d) / (s0 * s1)});
  const double sine = volume6 * std::sqrt(worst2);
  return std::isfinite(sine) ? sine : -1;
}

// Circumcentre of a triangle in space; far away for a degenerate one.
[[nodiscard]] inline Point3 triangle_circumcentre(Point3 a, Point3 b, Point3 c) {
  const Point3 u = b - a, v = c - a, n = cross(u, v);
  const double nn = dot(n, n);
  return a + (0.5 / nn) * (dot(u, u) * cross(v, n) + dot(v, v) * cross(n, u));
}

}  // namespace symcell
