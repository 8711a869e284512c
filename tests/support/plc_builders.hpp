// Small PLCs built by rule.
#pragma once

#include <cstdint>

#include "core/model/plc.hpp"

namespace symcell::test {

// Adds the six facets of an axis-parallel box; returns the index of its first vertex. Vertex
// first + i + 2 j + 4 k has the low (0) or high (1) coordinate in x (i), y (j), z (k); facets in
// the order low z, high z, low y, high y, low x, high x.
std::int32_t add_box(Plc& plc, Point3 low, Point3 high, std::int32_t marker = 0);

[[nodiscard]] Plc box(Point3 low, Point3 high);

// A prism over a regular polygon about the z axis, from z = 0 to `height`: vertices i below,
// corners + i above; facets bottom (marker 1), top (2), sides (3).
[[nodiscard]] Plc prism(std::int32_t corners, double radius, double height);

}  // namespace symcell::test
