#include "core/geometry/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace symcell {
namespace {

constexpr std::uint32_t kBits = kHilbertBits;  // a coordinate

}  // namespace

std::uint64_t hilbert_place(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  constexpr std::uint32_t kMost = (1U << kBits) - 1;  // the last place of an axis
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

std::vector<std::size_t> hilbert_order(std::span<const Point3> points) {
  if (points.empty()) return {};
  Point3 low = points.front(), high = low;
  for (const Point3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const double size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  const double scale = size > 0 ? (1U << kHilbertBits) / size : 0;
  const auto cell = [scale](double x) { return static_cast<std::uint32_t>(x * scale); };
  std::vector<std::pair<std::uint64_t, std::size_t>> places;
  places.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3 p = points[i] - low;
    places.emplace_back(hilbert_place(cell(p.x), cell(p.y), cell(p.z)), i);
  }
  std::sort(places.begin(), places.end());
  std::vector<std::size_t> order;
  order.reserve(places.size());
  for (const auto& [place, i] : places) order.push_back(i);
  return order;
}

void sort_along_hilbert_curve(std::span<Point3> points) {
  const std::vector<Point3> given(points.begin(), points.end());
  std::size_t next = 0;
  for (const std::size_t i : hilbert_order(given)) points[next++] = given[i];
}

}  // namespace symcell
