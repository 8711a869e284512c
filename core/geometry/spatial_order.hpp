// Places along a space-filling curve: what is near in space comes to lie near in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {

// Cells of the curve a side, as a power of two: enough for some hundred million places.
inline constexpr std::uint32_t kHilbertBits = 10;

// Place of a point along the Hilbert curve through the cube [0, 2^kHilbertBits)^3; coordinates
// above are cut off.  Source: [Skilling04].
[[nodiscard]] std::uint64_t hilbert_place(std::uint32_t x, std::uint32_t y, std::uint32_t z);

// Indices of the points in the order in which the curve through their bounding cube meets them.
[[nodiscard]] std::vector<std::size_t> hilbert_order(std::span<const Point3> points);
// Puts the points in that order.
void sort_along_hilbert_curve(std::span<Point3> points);

}  // namespace symcell
