// The rotations of C_n as one table of (cos, sin) per exponent.
//
// Invariants: exponent 0 and the quarter turns are exact; exponents k and n - k have equal cosine
// and opposite sine, so a rotation and its inverse are transposes. A point is always lifted from
// its representative, never by repeated rotation, so an image has one position only.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {

class RotationTable {
 public:
  // `fold` >= 1.
  explicit RotationTable(std::int32_t fold);

  [[nodiscard]] std::int32_t fold() const { return fold_; }

  // `exponent` in [0, fold).
  [[nodiscard]] Point2 rotate(Point2 p, std::int32_t exponent) const {
    if (exponent == 0) return p;
    const Entry& e = table_[static_cast<std::size_t>(exponent)];
    return {e.cosine * p.x - e.sine * p.y, e.sine * p.x + e.cosine * p.y};
  }

  // About the z axis.
  [[nodiscard]] Point3 rotate(Point3 p, std::int32_t exponent) const {
    const Point2 q = rotate(Point2{p.x, p.y}, exponent);
    return {q.x, q.y, p.z};
  }

  // Any exponent to [0, fold).
  [[nodiscard]] std::int32_t reduce(std::int64_t exponent) const {
    const std::int64_t r = exponent % fold_;
    return static_cast<std::int32_t>(r < 0 ? r + fold_ : r);
  }
  // Sum and difference of reduced exponents, reduced.
  [[nodiscard]] std::int32_t add(std::int32_t a, std::int32_t b) const {
    const std::int32_t s = a + b;
    return s >= fold_ ? s - fold_ : s;
  }
  [[nodiscard]] std::int32_t subtract(std::int32_t a, std::int32_t b) const {
    const std::int32_t s = a - b;
    return s < 0 ? s + fold_ : s;
  }

 private:
  struct Entry {
    double cosine;
    double sine;
  };
  std::int32_t fold_;
  std::vector<Entry> table_;
};

}  // namespace symcell
