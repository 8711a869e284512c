#include "core/geometry/resolution.hpp"

#include <algorithm>
#include <cmath>

namespace symcell {

double resolution_of(double diameter, double magnitude) {
  return std::max(1e-12 * diameter, 64 * 0x1p-53 * magnitude);
}

double resolution_of(std::span<const Point2> vertices) {
  if (vertices.empty()) return 0;
  Point2 low = vertices.front();
  Point2 high = low;
  for (const Point2 p : vertices) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return resolution_of(distance(low, high), std::max({std::abs(low.x), std::abs(low.y),
                                                      std::abs(high.x), std::abs(high.y)}));
}

}  // namespace symcell
