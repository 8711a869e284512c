// The digits that coordinates computed in double precision have.
#pragma once

#include <span>

#include "core/geometry/point.hpp"

namespace symcell {

// Distance below which positions of a model are the same: the digits that coordinates computed in
// double precision have.
[[nodiscard]] double resolution_of(double diameter, double magnitude);
[[nodiscard]] double resolution_of(std::span<const Point2> vertices);

}  // namespace symcell
