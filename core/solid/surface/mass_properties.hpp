// Centroid and principal axes of the solid that a surface encloses.
#pragma once

#include <array>

#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/point.hpp"

namespace symcell::solid {

struct MassProperties {
  double volume = 0;
  Point3 centroid;
  // Second moments about the centroid per volume, ascending, and their unit directions.
  std::array<double, 3> moments{};
  std::array<Point3, 3> directions;
};

// Requires: closed, consistently oriented; volume not 0.
[[nodiscard]] MassProperties mass_properties(const IndexedSurface& surface);

}  // namespace symcell::solid
