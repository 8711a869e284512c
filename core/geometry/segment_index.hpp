// Which segments lie near a point: a bounding-volume tree over segments, built once.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {

struct IndexedSegment {
  Point2 a;
  Point2 b;
};

[[nodiscard]] double squared_distance_to_segment(Point2 p, Point2 a, Point2 b);

class SegmentIndex {
 public:
  struct Hit {
    std::int32_t segment = -1;
    double distance = std::numeric_limits<double>::infinity();
  };

  // Ids are positions in `segments`. Cost: O(N log N).
  explicit SegmentIndex(std::span<const IndexedSegment> segments);

  // Nearest segment no farther than `radius` that `accept(id)` allows; the smallest id on ties.
  template <class Accept>
  [[nodiscard]] Hit nearest(Point2 p, double radius, Accept accept) const {
    Hit best;
    double limit = radius * radius;
    visit(p, limit, [&](std::int32_t id, double squared) {
      if (squared > limit || !accept(id)) return;
      if (squared == limit && best.segment >= 0 && id > best.segment) return;
      limit = squared;
      best = {id, std::sqrt(squared)};
    });
    return best;
  }
  [[nodiscard]] Hit nearest(Point2 p, double radius) const {
    return nearest(p, radius, [](std::int32_t) { return true; });
  }

  // Whether a segment that `accept(id)` allows is no farther than `radius`.
  template <class Accept>
  [[nodiscard]] bool any_within(Point2 p, double radius, Accept accept) const {
    bool found = false;
    double limit = radius * radius;
    visit(p, limit, [&](std::int32_t id, double squared) {
      if (squared > limit || !accept(id)) return;
      found = true;
      limit = -1;  // nothing is as near
    });
    return found;
  }

  // Calls `found(id, distance)` for every segment no farther than `radius`.
  template <class Found>
  void within(Point2 p, double radius, Found found) const {
    const double limit = radius * radius;
    visit(p, limit, [&](std::int32_t id, double squared) {
      if (squared <= limit) found(id, std::sqrt(squared));
    });
  }

 private:
  static constexpr std::int32_t kLeafSize = 4;  // segments: worth a node
  static constexpr double kUnset = std::numeric_limits<double>::infinity();  // empty box

  struct Box {
    Point2 low;
    Point2 high;
    [[nodiscard]] double squared_distance(Point2 p) const {
      const double dx = std::max({low.x - p.x, 0.0, p.x - high.x});
      const double dy = std::max({low.y - p.y, 0.0, p.y - high.y});
      return dx * dx + dy * dy;
    }
  };
  // Children of an inner node: the next node and `right`. A leaf has right = 0.
  struct Node {
    Box box;
    std::int32_t begin = 0;
    std::int32_t end = 0;
    std::int32_t right = 0;
  };

  // `limit` may shrink while the visit goes on.
  template <class Each>
  void visit(Point2 p, const double& limit, Each each) const {
    if (nodes_.empty()) return;
    std::int32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const std::int32_t index = stack[--depth];
      const Node& node = nodes_[static_cast<std::size_t>(index)];
      if (node.box.squared_distance(p) > limit) continue;
      if (node.right == 0) {
        for (std::int32_t i = node.begin; i < node.end; ++i) {
          const IndexedSegment& s = sorted_[static_cast<std::size_t>(i)];
          each(ids_[static_cast<std::size_t>(i)], squared_distance_to_segment(p, s.a, s.b));
        }
        continue;
      }
      std::int32_t near = index + 1;
      std::int32_t far = node.right;
      if (nodes_[static_cast<std::size_t>(far)].box.squared_distance(p) <
          nodes_[static_cast<std::size_t>(near)].box.squared_distance(p)) {
        std::swap(near, far);
      }
      stack[depth++] = far;
      stack[depth++] = near;
    }
  }

  void build(std::int32_t begin, std::int32_t end);

  std::vector<IndexedSegment> sorted_;
  std::vector<std::int32_t> ids_;
  std::vector<Node> nodes_;
};

}  // namespace symcell
