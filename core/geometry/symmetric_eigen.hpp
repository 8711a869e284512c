// Eigenvectors of a symmetric 3x3 matrix.
#pragma once

#include <array>

#include "core/geometry/point.hpp"

namespace symcell {

struct SymmetricEigen {
  std::array<double, 3> values{};  // ascending
  std::array<Point3, 3> vectors{};
};

// `m`: xx, xy, xz, yy, yz, zz.  Cyclic Jacobi rotations: vectors are orthonormal to rounding, also
// for equal values.
[[nodiscard]] SymmetricEigen symmetric_eigen(const std::array<double, 6>& m);

}  // namespace symcell
