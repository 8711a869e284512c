// Figures of tetrahedra as statistics and checks report them, gathered over many.
//
// Angles are compared by their cotangents, which fall from +inf at 0 to -inf at 180 degrees: no
// arcus functions in the loop, and no loss near flat angles as with cosines.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/point.hpp"

namespace symcell {

struct TetFigures {
  double volume = 0;       // input units cubed
  double radius_edge = 0;  // circumradius / shortest edge; inf for a flat tetrahedron
  double aspect = 0;       // longest edge / smallest height; likewise
  // Cotangents of the smallest and largest angles of the faces, and between faces.
  double face_cot_max = 0;
  double face_cot_min = 0;
  double dihedral_cot_max = 0;
  double dihedral_cot_min = 0;
};

[[nodiscard]] inline double degrees_of_cotangent(double cot) {
  return std::atan2(1.0, cot) * 180 / std::numbers::pi;
}

// Corners in VTK's order, positively oriented.
[[nodiscard]] inline TetFigures tet_figures(const std::array<Point3, 4>& p) {
  constexpr double kFar = std::numeric_limits<double>::infinity();  // no angle yet
  TetFigures f;
  f.face_cot_max = f.dihedral_cot_max = -kFar;
  f.face_cot_min = f.dihedral_cot_min = kFar;
  const Point3 u = p[1] - p[0], v = p[2] - p[0], w = p[3] - p[0];
  const Point3 uv = cross(u, v);
  const double six_volumes = dot(uv, w);
  f.volume = six_volumes / 6;

  // Outward normals, twice the faces' areas long; face i lies opposite corner i.
  const std::array<Point3, 4> normal{cross(p[2] - p[1], p[3] - p[1]), cross(w, v), cross(u, w),
                                     cross(v, u)};
  std::array<double, 4> doubled{};
  for (std::size_t i = 0; i < 4; ++i) doubled[i] = length(normal[i]);

  double shortest2 = kFar, longest2 = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      const Point3 edge = p[j] - p[i];
      const double edge2 = squared_length(edge);
      shortest2 = std::min(shortest2, edge2);
      longest2 = std::max(longest2, edge2);
      // The other two corners are those of the faces that meet at this edge.
      const std::size_t k = i == 0 ? (j == 1 ? 2 : 1) : 0;
      const std::size_t l = 6 - i - j - k;
      const double sine = length(cross(normal[k], normal[l]));
      const double dihedral = -dot(normal[k], normal[l]) / sine;
      f.dihedral_cot_max = std::max(f.dihedral_cot_max, dihedral);
      f.dihedral_cot_min = std::min(f.dihedral_cot_min, dihedral);
      // The angles that see this edge, in the two faces that have it.
      for (const auto& [corner, face] : {std::pair{k, l}, std::pair{l, k}}) {
        const double cot = dot(p[i] - p[corner], p[j] - p[corner]) / doubled[face];
        f.face_cot_max = std::max(f.face_cot_max, cot);
        f.face_cot_min = std::min(f.face_cot_min, cot);
      }
    }
  }
  const Point3 centre =
      squared_length(w) * uv + squared_length(v) * cross(w, u) + squared_length(u) * cross(v, w);
  f.radius_edge = length(centre) / (2 * std::abs(six_volumes) * std::sqrt(shortest2));
  f.aspect = std::sqrt(longest2) * *std::ranges::max_element(doubled) / std::abs(six_volumes);
  return f;
}

}  // namespace symcell
