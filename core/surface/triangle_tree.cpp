#include "core/surface/triangle_tree.hpp"

#include <algorithm>
#include <array>

namespace symcell {
namespace {

constexpr std::int32_t kLeafSize = 4;
// Halving 2^31 items ends well before; a stack of twice the depth is never full.
constexpr std::size_t kStackSize = 128;

double squared_distance_to_box(Point3 p, Point3 low, Point3 high) {
  const double dx = std::max({low.x - p.x, 0.0, p.x - high.x});
  const double dy = std::max({low.y - p.y, 0.0, p.y - high.y});
  const double dz = std::max({low.z - p.z, 0.0, p.z - high.z});
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace

// Source: [Ericson05] sec. 5.1.5, by regions of barycentric coordinates.
Point3 closest_point(Point3 p, Point3 a, Point3 b, Point3 c) {
  const Point3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Point3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return a + (d1 / (d1 - d3)) * ab;
  const Point3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0 && (d4 - d3) + (d5 - d6) > 0) {
    return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;  // no area: one of the sides above is as near, but for rounding
  return a + (vb / sum) * ab + (vc / sum) * ac;
}

TriangleTree::TriangleTree(std::span<const Point3> points, std::span<const Triangle> triangles) {
  items_.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle& v = triangles[t];
    items_.push_back({points[v[0]], points[v[1]], points[v[2]], static_cast<std::int32_t>(t)});
  }
  nodes_.reserve(items_.size());
  if (!items_.empty()) build(0, static_cast<std::int32_t>(items_.size()));
}

std::int32_t TriangleTree::build(std::int32_t begin, std::int32_t end) {
  const auto id = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  Point3 low = items_[begin].a, high = low;
  Point3 centre_low{1e300, 1e300, 1e300}, centre_high{-1e300, -1e300, -1e300};
  for (std::int32_t i = begin; i < end; ++i) {
    const Item& item = items_[i];
    for (const Point3& p : {item.a, item.b, item.c}) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Point3 s = item.a + item.b + item.c;
    centre_low = {std::min(centre_low.x, s.x), std::min(centre_low.y, s.y),
                  std::min(centre_low.z, s.z)};
    centre_high = {std::max(centre_high.x, s.x), std::max(centre_high.y, s.y),
                   std::max(centre_high.z, s.z)};
  }
  nodes_[id].low = low;
  nodes_[id].high = high;
  if (end - begin <= kLeafSize) {
    nodes_[id].begin = begin;
    nodes_[id].count = end - begin;
    return id;
  }
  const Point3 size = centre_high - centre_low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const auto key = [axis](const Item& item) {
    if (axis == 0) return item.a.x + item.b.x + item.c.x;
    if (axis == 1) return item.a.y + item.b.y + item.c.y;
    return item.a.z + item.b.z + item.c.z;
  };
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                   [&key](const Item& x, const Item& y) {
                     const double kx = key(x), ky = key(y);
                     return kx != ky ? kx < ky : x.triangle < y.triangle;
                   });
  build(begin, middle);
  const std::int32_t right = build(middle, end);
  nodes_[id].begin = right;
  return id;
}

// Calls visit(item) for items in boxes nearer than the reach; visit returns true to stop.
template <class Visit>
void TriangleTree::search(Point3 p, double& squared_reach, const Visit& visit) const {
  if (nodes_.empty()) return;
  struct Pending {
    std::int32_t node;
    double squared;
  };
  std::array<Pending, kStackSize> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, squared_distance_to_box(p, nodes_[0].low, nodes_[0].high)};
  while (depth > 0) {
    const Pending next = stack[--depth];
    if (next.squared > squared_reach) continue;
    const Node& node = nodes_[next.node];
    if (node.count > 0) {
      for (std::int32_t i = node.begin; i < node.begin + node.count; ++i) {
        if (visit(items_[i])) return;
      }
      continue;
    }
    const std::int32_t left = next.node + 1, right = node.begin;
    const double to_left = squared_distance_to_box(p, nodes_[left].low, nodes_[left].high);
    const double to_right = squared_distance_to_box(p, nodes_[right].low, nodes_[right].high);
    if (to_left <= to_right) {
      stack[depth++] = {right, to_right};
      stack[depth++] = {left, to_left};
    } else {
      stack[depth++] = {left, to_left};
      stack[depth++] = {right, to_right};
    }
  }
}

TriangleTree::Hit TriangleTree::nearest(Point3 p, double reach, std::int32_t& last) const {
  Hit hit;
  double squared_reach = reach * reach;
  const auto look = [&](const Item& item) {
    const Point3 q = closest_point(p, item.a, item.b, item.c);
    const double squared = squared_distance(p, q);
    const bool tie = squared == hit.squared && item.triangle < hit.triangle;
    if (squared <= squared_reach && (squared < hit.squared || tie)) {
      hit = {item.triangle, squared, q};
      squared_reach = squared;
      last = static_cast<std::int32_t>(&item - items_.data());
    }
    return false;
  };
  if (last >= 0) static_cast<void>(look(items_[last]));
  search(p, squared_reach, look);
  return hit;
}

bool TriangleTree::within(Point3 p, double reach, std::int32_t& last) const {
  bool found = false;
  double squared_reach = reach * reach;
  const auto look = [&](const Item& item) {
    found = squared_distance(p, closest_point(p, item.a, item.b, item.c)) <= squared_reach;
    return found;
  };
  if (last >= 0 && look(items_[last])) return true;
  search(p, squared_reach, [&](const Item& item) {
    if (look(item)) last = static_cast<std::int32_t>(&item - items_.data());
    return found;
  });
  return found;
}

}  // namespace symcell
