// Points in a hashed grid, for "which point lies within r of here" with a small fixed r.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {

class PointGrid {
 public:
  // `radius` > 0: of all later queries.  `expected`: number of points, for the table's size.
  PointGrid(double radius, std::size_t expected)
      : radius_(radius),
        cell_(4 * radius),
        heads_(std::bit_ceil(expected + 16), -1),
        mask_(heads_.size() - 1) {}

  void insert(Point2 p, std::int32_t id) {
    std::int32_t& head = heads_[slot(column(p.x), column(p.y))];
    entries_.push_back({p, id, head});
    head = static_cast<std::int32_t>(entries_.size()) - 1;
  }

  // Id of the nearest point no farther than the radius, -1 if none; the smallest id on ties.
  [[nodiscard]] std::int32_t nearest(Point2 p) const {
    double best = radius_ * radius_;
    std::int32_t result = -1;
    const std::int64_t x_end = column(p.x + radius_);
    const std::int64_t y_end = column(p.y + radius_);
    for (std::int64_t x = column(p.x - radius_); x <= x_end; ++x) {
      for (std::int64_t y = column(p.y - radius_); y <= y_end; ++y) {
        for (std::int32_t e = heads_[slot(x, y)]; e >= 0; e = entry(e).next) {
          const double squared = squared_distance(p, entry(e).point);
          if (squared > best) continue;
          if (squared == best && result >= 0 && entry(e).id > result) continue;
          best = squared;
          result = entry(e).id;
        }
      }
    }
    return result;
  }

 private:
  struct Entry {
    Point2 point;
    std::int32_t id;
    std::int32_t next;
  };

  [[nodiscard]] const Entry& entry(std::int32_t e) const {
    return entries_[static_cast<std::size_t>(e)];
  }
  [[nodiscard]] std::int64_t column(double x) const {
    return static_cast<std::int64_t>(std::floor(x / cell_));
  }
  [[nodiscard]] std::size_t slot(std::int64_t x, std::int64_t y) const {
    std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL;
    h = (h ^ (h >> 29)) + static_cast<std::uint64_t>(y) * 0xbf58476d1ce4e5b9ULL;
    h ^= h >> 32;
    h *= 0x94d049bb133111ebULL;
    return static_cast<std::size_t>(h ^ (h >> 31)) & mask_;
  }

  double radius_;
  double cell_;
  std::vector<std::int32_t> heads_;
  std::size_t mask_;
  std::vector<Entry> entries_;
};

}  // namespace symcell
