// The symmetry of a solid.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cell/warning.hpp"
#include "core/geometry/axis_frame.hpp"

namespace symcell::solid {

// What was found, for statistics and `inspect`.
struct Symmetry {
  std::int32_t fold = 1;
  AxisFrame frame;
  double error_rel = 0;  // largest over k = 1 .. n-1, as a share of the diameter
  double diameter = 0;   // bounding-box diagonal of the model
  bool fold_detected = false;
  bool axis_detected = false;
  std::vector<Warning> warnings;  // of the choice of fold and axis
};

}  // namespace symcell::solid
