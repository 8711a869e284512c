#include "core/geometry/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace symcell {
namespace {

constexpr std::size_t kLeafSize = 4;  // triangles: fewer cost nodes, more distances
// Halving 2^31 items ends well before; a stack of twice the depth is never full.
constexpr std::size_t kStackSize = 128;
// A triangle is thin if its height is below the root of this share of its longer side at the first
// corner. By products of dot products places are told in it with errors that grow as the
// square of the side over the height; there they are some hundred roundings.
constexpr double kThin = 1e-4;

inline double squared_distance_to_box(Point3 p, const Point3& low, const Point3& high) {
  const double dx = std::max(std::max(low.x - p.x, p.x - high.x), 0.0);
  const double dy = std::max(std::max(low.y - p.y, p.y - high.y), 0.0);
  const double dz = std::max(std::max(low.z - p.z, p.z - high.z), 0.0);
  return dx * dx + dy * dy + dz * dz;
}

bool meet(const Point3& low, const Point3& high, const Point3& low2, const Point3& high2) {
  return low.x <= high2.x && low2.x <= high.x && low.y <= high2.y && low2.y <= high.y &&
         low.z <= high2.z && low2.z <= high.z;
}

// How far along the ray the box begins; infinity: it misses it, or does not meet it before `most`.
double entry(const Point3& low, const Point3& high, Point3 from, Point3 direction, double most) {
  double enter = 0, leave = most;
  const auto narrow = [&](double least, double greatest, double at, double along) {
    const double inverse = 1 / along;
    double a = (least - at) * inverse, b = (greatest - at) * inverse;
    if (a > b) std::swap(a, b);
    // Not a number where the ray runs within a side: no bound.
    if (a > enter) enter = a;
    if (b < leave) leave = b;
  };
  narrow(low.x, high.x, from.x, direction.x);
  narrow(low.y, high.y, from.y, direction.y);
  narrow(low.z, high.z, from.z, direction.z);
  return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

// The foot of the perpendicular from p on the plane of a thin triangle, known to be inside it: from
// the foot on the longest side on, as what is left from there is no longer than the triangle is thin.
Point3 foot_in_thin(Point3 p, Point3 a, Point3 b, Point3 c) {
  const double ab2 = squared_distance(a, b);
  if (ab2 < std::max(squared_distance(b, c), squared_distance(c, a))) {
    return foot_in_thin(p, b, c, a);
  }
  const Point3 ab = b - a;
  const Point3 on_side = a + (dot(p - a, ab) / ab2) * ab;
  const Point3 across = c - a - (dot(c - a, ab) / ab2) * ab;
  const double across2 = squared_length(across);
  return across2 > 0 ? on_side + (dot(p - on_side, across) / across2) * across : on_side;
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
  const double ab2 = squared_length(ab), ac2 = squared_length(ac), abac = dot(ab, ac);
  const double longest2 = std::max(ab2, ac2);
  const bool thin = ab2 * ac2 - abac * abac <= kThin * longest2 * longest2;
  const Point3 cp = p - c;
  const Point3 normal = thin ? cross(ab, ac) : Point3{};
  const double vc = thin ? dot(normal, cross(ap, bp)) : d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return a + (d1 / (d1 - d3)) * ab;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = thin ? dot(normal, cross(cp, ap)) : d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return a + (d2 / (d2 - d6)) * ac;
  const double va = thin ? dot(normal, cross(bp, cp)) : d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0 && (d4 - d3) + (d5 - d6) > 0) {
    return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;  // no area: one of the sides above is as near, but for rounding
  return thin ? foot_in_thin(p, a, b, c) : a + (vb / sum) * ab + (vc / sum) * ac;
}

TriangleTree::TriangleTree(std::span<const Point3> points, std::span<const Triangle> triangles) {
  if (triangles.empty()) return;
  std::vector<Centroid> order;
  order.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle& v = triangles[t];
    const Point3 s = points[v[0]] + points[v[1]] + points[v[2]];
    order.push_back({{s.x, s.y, s.z}, static_cast<std::int32_t>(t)});
  }
  items_.reserve(triangles.size());
  nodes_.reserve(triangles.size());
  build(order, [&](std::int32_t t) {
    const Triangle& v = triangles[static_cast<std::size_t>(t)];
    return Item{points[v[0]], points[v[1]], points[v[2]], t};
  });
}

// Halves are built from left to right, so items come to lie in the order of their leaves.
template <class MakeItem>
std::int32_t TriangleTree::build(std::span<Centroid> order, const MakeItem& item) {
  const auto id = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  if (order.size() <= kLeafSize) {
    Node& leaf = nodes_[id];
    leaf.begin = static_cast<std::int32_t>(items_.size());
    leaf.count = static_cast<std::int32_t>(order.size());
    std::array<Point3, 3 * kLeafSize> corners;
    std::size_t count = 0;
    for (const Centroid& c : order) {
      items_.push_back(item(c.triangle));
      items_.back().leaf = id;
      for (const Point3& p : {items_.back().a, items_.back().b, items_.back().c}) {
        corners[count++] = p;
      }
    }
    const Box3 box = bounding_box(std::span(corners).first(count));
    leaf.low = box.low;
    leaf.high = box.high;
    return id;
  }
  std::array<double, 3> low = order.front().sum, high = low;
  for (const Centroid& c : order) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], c.sum[i]);
      high[i] = std::max(high[i], c.sum[i]);
    }
  }
  std::size_t axis = 0;
  for (const std::size_t i : {1, 2}) {
    if (high[i] - low[i] > high[axis] - low[axis]) axis = i;
  }
  const std::size_t half = order.size() / 2;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                   [axis](const Centroid& x, const Centroid& y) {
                     return x.sum[axis] != y.sum[axis] ? x.sum[axis] < y.sum[axis]
                                                       : x.triangle < y.triangle;
                   });
  const std::int32_t left = build(order.first(half), item);
  const std::int32_t right = build(order.subspan(half), item);
  nodes_[left].parent = nodes_[right].parent = id;
  nodes_[id].begin = right;
  const std::array<Point3, 4> ends = {nodes_[left].low, nodes_[left].high, nodes_[right].low,
                                      nodes_[right].high};
  const Box3 box = bounding_box(ends);
  nodes_[id].low = box.low;
  nodes_[id].high = box.high;
  return id;
}

// Calls visit(item) for items in boxes nearer than the reach, the nearer box first; visit returns
// true to stop, which is returned.
template <class Visit>
bool TriangleTree::search_below(std::int32_t root,
                                Point3 p,
                                double& squared_reach,
                                const Visit& visit) const {
  struct Pending {
    std::int32_t node;
    double squared;
  };
  std::array<Pending, kStackSize> stack;
  std::size_t depth = 0;
  stack[depth++] = {root, squared_distance_to_box(p, nodes_[root].low, nodes_[root].high)};
  while (depth > 0) {
    const Pending next = stack[--depth];
    if (next.squared > squared_reach) continue;
    const Node& node = nodes_[next.node];
    if (node.count > 0) {
      for (std::int32_t i = node.begin; i < node.begin + node.count; ++i) {
        if (visit(items_[i])) return true;
      }
      continue;
    }
    const std::int32_t left = next.node + 1, right = node.begin;
    const double to_left = squared_distance_to_box(p, nodes_[left].low, nodes_[left].high);
    const double to_right = squared_distance_to_box(p, nodes_[right].low, nodes_[right].high);
    if (to_left <= to_right) {
      if (to_right <= squared_reach) stack[depth++] = {right, to_right};
      stack[depth++] = {left, to_left};
    } else {
      if (to_left <= squared_reach) stack[depth++] = {left, to_left};
      stack[depth++] = {right, to_right};
    }
  }
  return false;
}

// From the leaf of item `last` up to the root, and from each node on the way down into its sibling;
// from the root if `last` is negative.
template <class Visit>
void TriangleTree::search(Point3 p,
                          double& squared_reach,
                          std::int32_t last,
                          const Visit& visit) const {
  if (nodes_.empty()) return;
  std::int32_t node = last < 0 ? 0 : items_[last].leaf;
  if (search_below(node, p, squared_reach, visit)) return;
  for (std::int32_t up = nodes_[node].parent; up >= 0; up = nodes_[node].parent) {
    const std::int32_t sibling = node == up + 1 ? nodes_[up].begin : up + 1;
    if (search_below(sibling, p, squared_reach, visit)) return;
    node = up;
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
  search(p, squared_reach, last, look);
  return hit;
}

bool TriangleTree::within(Point3 p, double reach, std::int32_t& last) const {
  bool found = false;
  double squared_reach = reach * reach;
  const auto look = [&](const Item& item) {
    found = squared_distance(p, closest_point(p, item.a, item.b, item.c)) <= squared_reach;
    if (found) last = static_cast<std::int32_t>(&item - items_.data());
    return found;
  };
  if (last >= 0 && look(items_[last])) return true;
  search(p, squared_reach, last, look);
  return found;
}

void TriangleTree::look_along(std::int32_t id,
                              Point3 from,
                              Point3 direction,
                              Meeting& first) const {
  const Node& node = nodes_[id];
  for (std::int32_t i = node.begin; i < node.begin + node.count; ++i) {
    const Item& item = items_[i];
    const Point3 u = item.b - item.a, v = item.c - item.a;
    const Point3 p = cross(direction, v);
    const double det = dot(u, p);
    if (det == 0) continue;
    const Point3 w = from - item.a;
    const double s = dot(w, p) / det;
    const Point3 q = cross(w, u);
    const double r = dot(direction, q) / det;
    if (s < 0 || r < 0 || s + r > 1) continue;
    const double distance = dot(v, q) / det;
    if (distance > 0 && distance < first.distance) first = {item.triangle, distance};
  }
  if (node.count > 0) return;
  std::int32_t near = id + 1, far = node.begin;
  const auto entry_of = [&](std::int32_t child) {
    return entry(nodes_[child].low, nodes_[child].high, from, direction, first.distance);
  };
  double enter = entry_of(near), other = entry_of(far);
  if (other < enter) {
    std::swap(near, far);
    std::swap(enter, other);
  }
  if (enter < first.distance) look_along(near, from, direction, first);
  if (other < first.distance) look_along(far, from, direction, first);
}

TriangleTree::Meeting TriangleTree::first_met(Point3 from, Point3 direction) const {
  Meeting first;
  if (!nodes_.empty()) look_along(0, from, direction, first);
  return first;
}

void TriangleTree::visit_meeting_boxes(const std::function<bool(std::int32_t, std::int32_t)>& visit,
                                       double reach) const {
  if (nodes_.empty()) return;
  const Point3 margin{reach, reach, reach};
  std::vector<Box3> boxes;
  boxes.reserve(items_.size());
  for (const Item& item : items_) {
    const std::array<Point3, 3> corners = {item.a, item.b, item.c};
    boxes.push_back(bounding_box(corners));
  }
  const auto items_meet = [&](std::int32_t i, std::int32_t j) {
    return meet(boxes[i].low - margin, boxes[i].high + margin, boxes[j].low, boxes[j].high) &&
           visit(items_[i].triangle, items_[j].triangle);
  };
  // Pairs of nodes whose boxes meet; a node with itself stands for the pairs within it.
  std::vector<std::pair<std::int32_t, std::int32_t>> pending{{0, 0}};
  const auto add = [&](std::int32_t a, std::int32_t b) {
    if (meet(nodes_[a].low - margin, nodes_[a].high + margin, nodes_[b].low, nodes_[b].high)) {
      pending.emplace_back(a, b);
    }
  };
  while (!pending.empty()) {
    const auto [a, b] = pending.back();
    pending.pop_back();
    const Node& na = nodes_[a];
    const Node& nb = nodes_[b];
    if (na.count > 0 && nb.count > 0) {
      for (std::int32_t i = na.begin; i < na.begin + na.count; ++i) {
        for (std::int32_t j = a == b ? i + 1 : nb.begin; j < nb.begin + nb.count; ++j) {
          if (items_meet(i, j)) return;
        }
      }
    } else if (a == b) {
      pending.emplace_back(a + 1, a + 1);
      pending.emplace_back(na.begin, na.begin);
      add(a + 1, na.begin);
    } else if (na.count > 0 ||
               (nb.count == 0 && distance(na.low, na.high) < distance(nb.low, nb.high))) {
      add(a, b + 1);
      add(a, nb.begin);
    } else {
      add(a + 1, b);
      add(na.begin, b);
    }
  }
}

}  // namespace symcell
