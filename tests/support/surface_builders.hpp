// Small closed surfaces whose shape is symmetric and whose triangles are not.
#pragma once

#include <cstdint>

#include "core/model/triangle_surface.hpp"

namespace symcell {

struct PrismShape {
  std::int32_t fold = 5;
  double outer = 2;
  double inner_tip = 1.4;  // the star's other radius
  double bore = 0.5;       // 0: solid on the axis
  double height = 1;
  double twist = 0;  // radians from bottom to top
  std::int32_t layers = 3;
  std::int32_t pieces = 3;  // most per side of the star; their number and place are random
};

// A star prism about the z axis, each side cut at random places; triangles as an STL has them, each
// with corners of its own.
[[nodiscard]] TriangleSurface asymmetric_prism(const PrismShape& shape, std::uint64_t seed);

// An axis-parallel box, positive outside.
[[nodiscard]] TriangleSurface box_surface(Point3 low, Point3 high);

// A ring of that many sides about the z axis, from z = 0 on.
[[nodiscard]] TriangleSurface ring_surface(std::int32_t sides,
                                           double outer,
                                           double inner,
                                           double height);

// About an axis through `origin` along `direction` instead of z.
void move_to_axis(TriangleSurface& surface, Point3 origin, Point3 direction);

void append(TriangleSurface& surface, const TriangleSurface& other);
void turn_inside_out(TriangleSurface& surface);

}  // namespace symcell
