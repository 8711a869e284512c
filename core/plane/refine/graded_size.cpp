#include "core/plane/refine/graded_size.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace symcell::plane {
namespace {

constexpr std::size_t kLeafSize = 8;  // sources: below, a look at each is quicker than a tree

}  // namespace

GradedSize::GradedSize(std::vector<Source> sources, double gradation)
    : gradation_(gradation), slope_(gradation - 1), sources_(std::move(sources)) {
  if (!sources_.empty()) build(0, sources_.size());
}

std::size_t GradedSize::build(std::size_t first, std::size_t last) {
  const std::size_t id = nodes_.size();
  Node node{sources_[first].p, sources_[first].p, kInfinity, first, last, 0};
  for (std::size_t i = first; i < last; ++i) {
    const Source& s = sources_[i];
    node.low = {std::min(node.low.x, s.p.x), std::min(node.low.y, s.p.y)};
    node.high = {std::max(node.high.x, s.p.x), std::max(node.high.y, s.p.y)};
    node.least = std::min(node.least, s.size);
  }
  nodes_.push_back(node);
  if (last - first <= kLeafSize) return id;
  const bool along_x = node.high.x - node.low.x >= node.high.y - node.low.y;
  const auto begin = sources_.begin();
  const std::size_t middle = first + (last - first) / 2;
  std::nth_element(
      begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(middle),
      begin + static_cast<std::ptrdiff_t>(last),
      [&](const Source& a, const Source& b) { return along_x ? a.p.x < b.p.x : a.p.y < b.p.y; });
  build(first, middle);
  const std::size_t right = build(middle, last);
  nodes_[id].right = right;
  return id;
}

double GradedSize::bound_of(const Node& node, Point2 x) const {
  const double dx = std::max({node.low.x - x.x, 0.0, x.x - node.high.x});
  const double dy = std::max({node.low.y - x.y, 0.0, x.y - node.high.y});
  return node.least + slope_ * std::hypot(dx, dy);
}

void GradedSize::look_at(std::size_t id, Point2 x, double& best) const {
  const Node& node = nodes_[id];
  if (node.right == 0) {
    for (std::size_t i = node.first; i < node.last; ++i) {
      best = std::min(best, sources_[i].size + slope_ * distance(sources_[i].p, x));
    }
    return;
  }
  std::pair<double, std::size_t> near{bound_of(nodes_[id + 1], x), id + 1};
  std::pair<double, std::size_t> far{bound_of(nodes_[node.right], x), node.right};
  if (far < near) std::swap(near, far);
  if (near.first < best) look_at(near.second, x, best);
  if (far.first < best) look_at(far.second, x, best);
}

double GradedSize::max_edge(Point2 x) const {
  double size = kInfinity;
  if (!nodes_.empty()) look_at(0, x, size);
  return gradation_ * size;
}

}  // namespace symcell::plane
