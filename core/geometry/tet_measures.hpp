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
  Point3 middle;      // the centroid

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
  m.middle = 0.25 * (a + b + c + d);
  m.shortest2 = std::min({uu, vv, ww, bc, bd, cd});
  m.longest2 = std::max({uu, vv, ww, bc, bd, cd});
  if (det == 0) {
    m.centre = m.middle;
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

// A face with what the measures of all tetrahedra on it share: the face that stays while a vertex
// moves. Counter-clockwise seen from outside, so that (p, a, b, c) is positive.
struct LinkFace {
  Point3 a, b, c;
  double normal2 = 0;  // (twice the area) squared
  double ab2 = 0, bc2 = 0, ca2 = 0;

  LinkFace() = default;
  LinkFace(Point3 first, Point3 second, Point3 third) : a(first), b(second), c(third) {
    const Point3 n = cross(b - a, c - a);
    normal2 = dot(n, n);
    ab2 = squared_distance(a, b);
    bc2 = squared_distance(b, c);
    ca2 = squared_distance(c, a);
  }
};

// The tetrahedron (p, face): as min_dihedral_sine and measure_tet (without the centre), up to
// rounding, in one go. The measures are left out where the sine is not above `least`.
struct LinkTet {
  // At most `least` where it is not above it, and then of no further meaning.
  double sine = -1;
  TetMeasures measures;

  LinkTet(Point3 p, const LinkFace& f, double least) {
    const Point3 u = f.a - p, v = f.b - p, w = f.c - p;
    const Point3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
    const double det = dot(u, vw);
    const double uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
    const double s1 = dot(vw, vw), s2 = dot(wu, wu), s3 = dot(uv, uv);
    const double s23 = s2 * s3, s13 = s1 * s3, s12 = s1 * s2;
    const double s03 = f.normal2 * s3, s01 = f.normal2 * s1, s02 = f.normal2 * s2;
    // Most places that are tried are refused: without the divisions.
    if (least >= 0) {
      const double det2 = det * det, least2 = kSurely * (least * least);
      if (det <= 0 || det2 * uu < least2 * s23 || det2 * vv < least2 * s13 ||
          det2 * ww < least2 * s12 || det2 * f.ab2 < least2 * s03 || det2 * f.bc2 < least2 * s01 ||
          det2 * f.ca2 < least2 * s02) {
        return;
      }
    }
    const double worst2 =
        std::min({uu / s23, vv / s13, ww / s12, f.ab2 / s03, f.bc2 / s01, f.ca2 / s02});
    sine = det * std::sqrt(worst2);
    if (!std::isfinite(sine)) sine = -1;
    if (!(sine > least)) return;
    measures.volume = det / 6;
    measures.middle = p + 0.25 * (u + v + w);
    measures.shortest2 = std::min({uu, vv, ww, f.ab2, f.bc2, f.ca2});
    measures.longest2 = std::max({uu, vv, ww, f.ab2, f.bc2, f.ca2});
    const Point3 r = uu * vw + vv * wu + ww * uv;
    measures.radius2 =
        det != 0 ? 0.25 * dot(r, r) / (det * det) : std::numeric_limits<double>::infinity();
  }

 private:
  // Of a squared sine: what is below this share of a limit is so whatever the rounding, which is some
  // 1e-15 of either side.
  static constexpr double kSurely = 1 - 1e-12;
};

// Circumcentre of a triangle in space; far away for a degenerate one.
[[nodiscard]] inline Point3 triangle_circumcentre(Point3 a, Point3 b, Point3 c) {
  const Point3 u = b - a, v = c - a, n = cross(u, v);
  const double nn = dot(n, n);
  return a + (0.5 / nn) * (dot(u, u) * cross(v, n) + dot(v, v) * cross(n, u));
}

}  // namespace symcell
