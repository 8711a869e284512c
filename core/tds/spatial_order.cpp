#include "core/tds/spatial_order.hpp"

#include <algorithm>
#include <array>

namespace symcell {
namespace {

constexpr std::uint32_t kBits = kHilbertBits;

}  // namespace

std::uint64_t hilbert_place(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  constexpr std::uint32_t kMost = (1U << kBits) - 1;
  std::array<std::uint32_t, 3> c = {std::min(x, kMost), std::min(y, kMost), std::min(z, kMost)};
  // From the finest bit but one up, cells are reflected or their axes exchanged: inverse undo.
  for (std::uint32_t bit = 1U << (kBits - 1); bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& axis : c) {
      if ((axis & bit) != 0) {
        c[0] ^= below;
      } else {
        const std::uint32_t swapped = (c[0] ^ axis) & below;
        c[0] ^= swapped;
        axis ^= swapped;
      }
    }
  }
  // Gray code.
  c[1] ^= c[0];
  c[2] ^= c[1];
  std::uint32_t flip = 0;
  for (std::uint32_t bit = 1U << (kBits - 1); bit > 1; bit >>= 1) {
    if ((c[2] & bit) != 0) flip ^= bit - 1;
  }
  std::uint64_t place = 0;
  for (std::uint32_t& axis : c) axis ^= flip;
  for (std::uint32_t i = kBits; i-- > 0;) {
    for (const std::uint32_t axis : c) place = place << 1 | (axis >> i & 1);
  }
  return place;
}

}  // namespace symcell
