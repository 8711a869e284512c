// Straight chains of mesh edges, and the elements that hold given points.
#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

#include "core/geometry/predicates.hpp"
#include "core/geometry/predicates_3.hpp"
#include "core/verify/against_model.hpp"

namespace symcell::internal {
namespace {

// Also on the element's boundary.
bool holds(const std::array<Point3, 4>& p, const Point3& q, std::int32_t dimension) {
  if (dimension == 2) {
    const Point2 a = planar(p[0]), b = planar(p[1]), c = planar(p[2]), d = planar(q);
    return orientation(a, b, d) != Sign::kNegative && orientation(b, c, d) != Sign::kNegative &&
           orientation(c, a, d) != Sign::kNegative;
  }
  return orientation_3(q, p[1], p[2], p[3]) != Sign::kNegative &&
         orientation_3(p[0], q, p[2], p[3]) != Sign::kNegative &&
         orientation_3(p[0], p[1], q, p[3]) != Sign::kNegative &&
         orientation_3(p[0], p[1], p[2], q) != Sign::kNegative;
}

}  // namespace

NodeGraph::NodeGraph(const MeshData& mesh) : first_(mesh.points.size() + 1, 0) {
  const std::vector<ElementEdge> edges = element_edges(mesh);
  for (const ElementEdge& e : edges) {
    ++first_[static_cast<std::size_t>(e.low) + 1];
    ++first_[static_cast<std::size_t>(e.high) + 1];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  around_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const ElementEdge& e : edges) {
    around_[next[static_cast<std::size_t>(e.low)]++] = e.high;
    around_[next[static_cast<std::size_t>(e.high)]++] = e.low;
  }
}

std::vector<std::int32_t> straight_chain(const MeshData& mesh,
                                         const NodeGraph& graph,
                                         std::int32_t from,
                                         std::int32_t to,
                                         double tolerance) {
  const auto point = [&](std::int32_t node) { return mesh.points[static_cast<std::size_t>(node)]; };
  const Point3 start = point(from);
  const double whole = distance(start, point(to));
  std::vector<std::int32_t> chain{from};
  if (!(whole > 0)) return from == to ? chain : std::vector<std::int32_t>{};
  const Point3 along = (1 / whole) * (point(to) - start);
  // Where another line runs within the tolerance the next node may be of that one: it leads nowhere, and
  // the one after is tried.
  struct Step {
    double ahead;
    std::int32_t node;
  };
  std::vector<std::vector<Step>> open;  // per node of the chain: where it may go, the nearest last
  std::set<std::int32_t> met{from};
  const auto look_from = [&](std::int32_t node) {
    const double here = dot(point(node) - start, along);
    std::vector<Step>& steps = open.emplace_back();
    for (const std::int32_t next : graph.around(node)) {
      const Point3 d = point(next) - start;
      const double there = dot(d, along);
      if (length(cross(along, d)) > tolerance || there <= here || there > whole + 2 * tolerance) {
        continue;
      }
      steps.push_back({there, next});
    }
    std::ranges::sort(steps, [](const Step& x, const Step& y) {
      return std::tie(x.ahead, x.node) > std::tie(y.ahead, y.node);
    });
  };
  look_from(from);
  while (chain.back() != to) {
    if (open.back().empty()) {
      chain.pop_back();
      open.pop_back();
      if (chain.empty()) return {};
      continue;
    }
    const std::int32_t next = open.back().back().node;
    open.back().pop_back();
    if (!met.insert(next).second) continue;
    chain.push_back(next);
    look_from(next);
  }
  return chain;
}

void each_holding_element(const MeshData& mesh,
                          const std::vector<Point3>& points,
                          const std::function<void(std::size_t, std::size_t)>& f) {
  if (points.empty()) return;
  std::vector<std::size_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto x = [&](std::size_t i) { return points[i].x; };
  std::ranges::sort(order, {}, x);
  const auto corners = static_cast<std::size_t>(mesh.dimension) + 1;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const std::array<Point3, 4> p = corners_of(mesh, e);
    double left = kFar, right = -kFar;
    for (std::size_t i = 0; i < corners; ++i) {
      left = std::min(left, p[i].x);
      right = std::max(right, p[i].x);
    }
    for (auto at = std::ranges::lower_bound(order, left, {}, x);
         at != order.end() && points[*at].x <= right; ++at) {
      if (holds(p, points[*at], mesh.dimension)) f(*at, e);
    }
  }
}

}  // namespace symcell::internal
