// Places along a space-filling curve: what is near in space comes to lie near in memory.
#pragma once

#include <cstdint>

namespace symcell {

// Cells of the curve a side, as a power of two: enough for some hundred million places.
inline constexpr std::uint32_t kHilbertBits = 10;

// Place of a point along the Hilbert curve through the cube [0, 2^kHilbertBits)^3; coordinates
// above are cut off.  Source: [Skilling04].
[[nodiscard]] std::uint64_t hilbert_place(std::uint32_t x, std::uint32_t y, std::uint32_t z);

}  // namespace symcell
