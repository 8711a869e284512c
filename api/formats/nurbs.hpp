// Non-uniform rational B-splines of the plane.
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {

struct Nurbs {
  std::size_t degree = 3;
  std::vector<double> knots;  // ascending, controls + degree + 1
  std::vector<Point2> controls;
  std::vector<double> weights;  // per control; empty: all 1

  // Whether numbers fit each other, and knots and weights are in order.
  [[nodiscard]] bool valid() const;
  [[nodiscard]] double begin() const { return knots[degree]; }
  [[nodiscard]] double end() const { return knots[controls.size()]; }
  // Requires: valid(), begin() <= t <= end().  Source: de Boor's algorithm.
  [[nodiscard]] Point2 at(double t) const;
};

}  // namespace symcell
