// Where random models are put, and chance that treats copies alike.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/axis_frame.hpp"

namespace symcell::test {

// Where a model is put: of any size, about any axis.
struct Placement {
  explicit Placement(Random& random) {
    const auto between = [&](double low, double high) {
      return low + (high - low) * random.uniform();
    };
    if (random.uniform() < 0.5) scale = std::pow(10, between(-3, 3));
    if (random.uniform() < 0.7) {
      direction = {between(-1, 1), between(-1, 1), between(-1, 1)};
      if (length(direction) < 0.1) direction = {1, 1, 0};
    }
    if (random.uniform() < 0.6) {
      const double far = scale * std::pow(10, between(-1, 2));
      origin = {far * between(-1, 1), far * between(-1, 1), far * between(-1, 1)};
    }
    frame = AxisFrame::of_axis(origin, direction);
  }
  [[nodiscard]] Point3 operator()(Point3 p) const { return frame.to_model(scale * p); }

  double scale = 1;
  Point3 direction{0, 0, 1};
  Point3 origin;
  AxisFrame frame;
};

[[nodiscard]] inline double box_diagonal(const std::vector<Point3>& points) {
  Point3 low = points.front(), high = low;
  for (const Point3 p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return distance(low, high);
}

// By chance, but alike for all that has one number: copies of each other.
class Coin {
 public:
  Coin(Random& random, double chance) : salt_(random.next()), chance_(chance) {}
  [[nodiscard]] double share(std::int64_t number) const {
    Random random(salt_ ^ (static_cast<std::uint64_t>(number) * 0x9e3779b97f4a7c15u));
    return random.uniform();
  }
  [[nodiscard]] bool operator()(std::int64_t number) const { return share(number) < chance_; }

 private:
  std::uint64_t salt_;
  double chance_;
};

}  // namespace symcell::test
