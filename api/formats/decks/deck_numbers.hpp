// Numbers as decks take them.
#pragma once

#include <string>

#include "core/geometry/point.hpp"

namespace symcell::internal {

// Shortest text that reads back as the same number if it fits `width` bytes, else as many digits as
// fit. CalculiX reads the first 20 bytes of a field and says nothing of the rest.
[[nodiscard]] std::string fitting_number(double value, std::size_t width);

// The same with a decimal point, as Nastran wants it, and an exponent without "e".
[[nodiscard]] std::string nastran_number(double value, std::size_t width);

// Rounding of a turned coordinate next to 0 made 0. `size`: of the model.
[[nodiscard]] Point3 without_rounding(const Point3& p, double size);

}  // namespace symcell::internal
