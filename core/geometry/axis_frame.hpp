// The frame of a symmetry axis: orthonormal, right-handed, its third axis along the symmetry axis.
#pragma once

#include <array>

#include "core/geometry/point.hpp"

namespace symcell {

struct AxisFrame {
  Point3 origin;
  std::array<double, 9> matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major: model = origin + m * local

  // The frame of the axis through `origin` along `direction` (any length > 0). The axes of the
  // coordinate system give exact entries (0, 1, -1).
  [[nodiscard]] static AxisFrame of_axis(Point3 origin, Point3 direction);

  [[nodiscard]] Point3 direction() const { return {matrix[2], matrix[5], matrix[8]}; }
  [[nodiscard]] Point3 to_local(Point3 p) const {
    const Point3 d = p - origin;
    const auto& m = matrix;
    return {m[0] * d.x + m[3] * d.y + m[6] * d.z, m[1] * d.x + m[4] * d.y + m[7] * d.z,
            m[2] * d.x + m[5] * d.y + m[8] * d.z};
  }
  [[nodiscard]] Point3 to_model(Point3 p) const {
    const auto& m = matrix;
    return {origin.x + (m[0] * p.x + m[1] * p.y + m[2] * p.z),
            origin.y + (m[3] * p.x + m[4] * p.y + m[5] * p.z),
            origin.z + (m[6] * p.x + m[7] * p.y + m[8] * p.z)};
  }
};

}  // namespace symcell
