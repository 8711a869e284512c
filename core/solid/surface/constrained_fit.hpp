// The displacement of a vertex that brings the triangles at it to wanted heights, in directions
// that keep given planes.
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell::solid {

class ConstrainedFit {
 public:
  // Moves along this unit normal are forbidden.
  void keep(Point3 normal);
  // Wanted: dot(normal, displacement) = height, with this weight.
  void pull(Point3 normal, double height, double weight);
  // Least squares, short where the pulls say little; zero if all directions are forbidden.
  [[nodiscard]] Point3 displacement() const;

 private:
  struct Pull {
    Point3 normal;
    double height;
    double weight;
  };
  std::vector<Point3> kept_;  // orthonormal
  std::vector<Pull> pulls_;
};

}  // namespace symcell::solid
