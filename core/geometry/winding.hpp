// How often a closed surface winds round a point.
#pragma once

#include <cstdint>
#include <span>

#include "core/geometry/indexed_surface.hpp"

namespace symcell {

// Solid angle of the triangle seen from p: positive if p is behind it, 0 from within its plane
// outside of it.
// Source: [van Oosterom-Strackee83].
[[nodiscard]] double solid_angle(const IndexedSurface& surface, std::int32_t triangle, Point3 p);

// Sum over all triangles, or over those named, over 4 pi: 1 inside a closed surface, 0 outside.
[[nodiscard]] double winding_number(const IndexedSurface& surface, Point3 p);
[[nodiscard]] double winding_number(const IndexedSurface& surface,
                                    std::span<const std::int32_t> triangles,
                                    Point3 p);

}  // namespace symcell
