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

// A prism with ribs on its top that begin flush with a side and end before the axis: the top is one
// facet with slots, and there is material beyond the slots.
struct RibbedShape {
  std::int32_t sides = 4;
  std::int32_t every = 1;   // ribs on sides 0, every, 2 every, ...
  double apothem = 4;       // of the prism
  double half_width = 0.5;  // of a rib
  double inner = 1;         // distance of its end from the axis
  double height = 4;        // of the prism
  double rib_height = 2;    // above it
};
[[nodiscard]] Plc ribbed_prism(const RibbedShape& shape);
[[nodiscard]] double ribbed_volume(const RibbedShape& shape);

// A thin prism across a thick one, both over regular polygons about the z axis; facets where they
// meet have a hole each.
[[nodiscard]] Plc bar_through_plate(
    std::int32_t sides, double plate_radius, double bar_radius, double thickness, double length);

}  // namespace symcell::test
