// Nearest points in space: a packed R-tree (Boost.Geometry), built once.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>

#include "core/geometry/point.hpp"

namespace symcell {

class PointTree {
 public:
  struct Hit {
    std::int32_t point = -1;
    double distance = std::numeric_limits<double>::infinity();
  };

  // Ids are positions in `points`.  Cost: O(N log N).
  explicit PointTree(std::span<const Point3> points);
  PointTree(PointTree&&) noexcept;
  PointTree& operator=(PointTree&&) noexcept;
  ~PointTree();

  // {-1, inf} if there are no points.
  [[nodiscard]] Hit nearest(Point3 p) const;
  // All ids inside the closed box, in no particular order.
  void within_box(Point3 low, Point3 high, const std::function<void(std::int32_t)>& visit) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace symcell
