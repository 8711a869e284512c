#include "core/geometry/rotation.hpp"

#include <cmath>
#include <numbers>

#include "core/base/assert.hpp"

namespace symcell {
namespace {

// cos and sin of 2 pi k / n by reduction to the first octant, so that symmetric exponents give
// bitwise equal or opposite values and quarter turns are exact.
struct CosSin {
  double cosine;
  double sine;
};

CosSin unit_root(std::int64_t k, std::int64_t n) {
  if (2 * k > n) {
    const CosSin m = unit_root(n - k, n);
    return {m.cosine, -m.sine};
  }
  if (4 * k > n) {
    // Angle pi - a with a = 2 pi (n - 2k) / (2n).
    const CosSin m = unit_root(n - 2 * k, 2 * n);
    return {-m.cosine, m.sine};
  }
  if (8 * k > n) {
    // Angle pi/2 - a with a = 2 pi (n - 4k) / (4n).
    const CosSin m = unit_root(n - 4 * k, 4 * n);
    return {m.sine, m.cosine};
  }
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

RotationTable::RotationTable(std::int32_t fold) : fold_(fold) {
  SYMCELL_ASSERT(fold >= 1);
  table_.reserve(static_cast<std::size_t>(fold));
  for (std::int32_t k = 0; k < fold; ++k) {
    const CosSin e = unit_root(k, fold);
    table_.push_back({e.cosine, e.sine});
  }
}

}  // namespace symcell
