#include "core/geometry/segment_index.hpp"

#include <numeric>

namespace symcell {

double squared_distance_to_segment(Point2 p, Point2 a, Point2 b) {
  const Point2 u = b - a;
  const Point2 v = p - a;
  const double along = dot(u, v);
  const double size = dot(u, u);
  if (along <= 0 || size <= 0) return dot(v, v);
  if (along >= size) return squared_distance(p, b);
  // From the cross product, not from the foot point: it keeps its digits for points on the line.
  const double area = cross(u, v);
  return area * area / size;
}

SegmentIndex::SegmentIndex(std::span<const IndexedSegment> segments)
    : sorted_(segments.begin(), segments.end()), ids_(segments.size()) {
  std::iota(ids_.begin(), ids_.end(), 0);
  if (segments.empty()) return;
  nodes_.reserve(segments.size());
  build(0, static_cast<std::int32_t>(segments.size()));
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    sorted_[i] = segments[static_cast<std::size_t>(ids_[i])];
  }
}

// Depth is at most log2(N / kLeafSize) + 2, well below the stack of `visit`.
void SegmentIndex::build(std::int32_t begin, std::int32_t end) {
  const std::size_t index = nodes_.size();
  Box box{{kUnset, kUnset}, {-kUnset, -kUnset}};
  for (std::int32_t i = begin; i < end; ++i) {
    const IndexedSegment& s = sorted_[static_cast<std::size_t>(ids_[static_cast<std::size_t>(i)])];
    box.low = {std::min({box.low.x, s.a.x, s.b.x}), std::min({box.low.y, s.a.y, s.b.y})};
    box.high = {std::max({box.high.x, s.a.x, s.b.x}), std::max({box.high.y, s.a.y, s.b.y})};
  }
  nodes_.push_back({box, begin, end, 0});
  if (end - begin <= kLeafSize) return;
  const bool by_x = box.high.x - box.low.x >= box.high.y - box.low.y;
  const auto key = [&](std::int32_t id) {
    const IndexedSegment& s = sorted_[static_cast<std::size_t>(id)];
    return by_x ? s.a.x + s.b.x : s.a.y + s.b.y;
  };
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(ids_.begin() + begin, ids_.begin() + middle, ids_.begin() + end,
                   [&](std::int32_t i, std::int32_t j) { return key(i) < key(j); });
  build(begin, middle);
  nodes_[index].right = static_cast<std::int32_t>(nodes_.size());
  build(middle, end);
}

}  // namespace symcell
