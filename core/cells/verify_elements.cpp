#include <algorithm>
#include <charconv>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/cells/verify_support.hpp"
#include "core/geometry/predicates.hpp"

namespace symcell {

bool VerifyReport::ok() const {
  return !checks.empty() && std::ranges::none_of(checks, [](const Check& c) {
    return c.status == Check::Status::kFail;
  });
}

namespace internal {
namespace {

// Mid nodes farther from the midpoint than this share of the edge are refused.
constexpr double kMidTolerance = 1e-6;
// Nodes closer than this share of the diameter are one node written twice.
constexpr double kDuplicateTolerance = 1e-10;

Point2 corner(const MeshData& mesh, std::size_t element, std::size_t i) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  return planar(mesh.points[static_cast<std::size_t>(mesh.elements[element * k + i])]);
}

bool check_fields(const MeshData& mesh, const std::string& tag, Checks& checks) {
  std::string wrong;
  const Point3& u = mesh.axis_direction;
  if (mesh.dimension != 2) wrong = "only planar meshes are checked";
  if (mesh.fold < 1) wrong = "fold " + std::to_string(mesh.fold) + " is below 1";
  if (u.x != 0 || u.y != 0 || std::abs(u.z) != 1) wrong = "the axis is not normal to the plane";
  if (mesh.elements.empty()) wrong = "no elements";
  for (std::size_t i = 0; i < mesh.points.size() && wrong.empty(); ++i) {
    const Point3& p = mesh.points[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || p.z != 0) {
      wrong = "node " + std::to_string(i) + " is not finite or not in the plane z = 0";
    }
  }
  return checks.add(tag + ".fields", wrong.empty(), wrong);
}

bool check_corners(const MeshData& mesh, const std::string& tag, Checks& checks) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  std::vector<char> used(mesh.points.size(), 0);
  std::string wrong;
  for (std::size_t at = 0; at < mesh.elements.size(); at += k) {
    for (std::size_t i = 0; i < k; ++i) {
      used[static_cast<std::size_t>(mesh.elements[at + i])] = 1;
      for (std::size_t j = 0; j < i && wrong.empty(); ++j) {
        if (mesh.elements[at + i] == mesh.elements[at + j]) {
          wrong = "element " + std::to_string(at / k) + " names a node twice";
        }
      }
    }
  }
  const auto unused = std::ranges::find(used, 0);
  if (unused != used.end() && wrong.empty()) {
    wrong = "node " + std::to_string(unused - used.begin()) + " belongs to no element";
  }
  return checks.add(tag + ".corners", wrong.empty(), wrong);
}

bool check_orientation(const MeshData& mesh, const std::string& tag, Checks& checks) {
  std::size_t bad = 0;
  std::size_t first = 0;
  for (std::size_t e = mesh.element_count(); e-- > 0;) {
    const Sign sign = orientation(corner(mesh, e, 0), corner(mesh, e, 1), corner(mesh, e, 2));
    if (sign == Sign::kPositive) continue;
    ++bad;
    first = e;
  }
  return checks.add(tag + ".orientation", bad == 0,
                    bad == 0 ? ""
                             : std::to_string(bad) + " elements are flat or turned over, first " +
                                   std::to_string(first));
}

// Sorted into columns wider than the tolerance, close nodes stand side by side; the second pass
// shifts the columns, for pairs that a column's border parts.
bool check_duplicates(const MeshData& mesh,
                      const std::string& tag,
                      double diameter,
                      Checks& checks) {
  const double tolerance = kDuplicateTolerance * diameter;
  const double width = std::max(4 * tolerance, std::numeric_limits<double>::min());
  double left = std::numeric_limits<double>::infinity();
  for (const Point3& p : mesh.points) left = std::min(left, p.x);
  std::vector<std::pair<double, std::size_t>> order(mesh.points.size());
  std::string wrong;
  for (const double shift : {0.0, 0.5}) {
    for (std::size_t i = 0; i < order.size(); ++i) {
      order[i] = {std::floor((mesh.points[i].x - left) / width + shift), i};
    }
    std::ranges::sort(order, [&](const auto& a, const auto& b) {
      return std::tuple(a.first, mesh.points[a.second].y, a.second) <
             std::tuple(b.first, mesh.points[b.second].y, b.second);
    });
    for (std::size_t i = 0; i < order.size() && wrong.empty(); ++i) {
      const Point3& p = mesh.points[order[i].second];
      for (std::size_t j = i + 1; j < order.size() && order[j].first == order[i].first; ++j) {
        const Point3& q = mesh.points[order[j].second];
        if (q.y - p.y > tolerance) break;
        if (std::abs(q.x - p.x) > tolerance) continue;
        wrong = "nodes " + std::to_string(order[i].second) + " and " +
                std::to_string(order[j].second) + " coincide";
        break;
      }
    }
  }
  return checks.add(tag + ".duplicates", wrong.empty(), wrong);
}

bool check_conforming(const std::vector<HalfEdge>& edges,
                      const std::vector<std::size_t>& groups,
                      const std::string& tag,
                      Checks& checks) {
  std::string wrong;
  for (std::size_t g = 0; g + 1 < groups.size() && wrong.empty(); ++g) {
    const HalfEdge& first = edges[groups[g]];
    const std::size_t count = groups[g + 1] - groups[g];
    const std::string name = "edge " + std::to_string(first.low) + "-" + std::to_string(first.high);
    if (count > 2) wrong = name + " has " + std::to_string(count) + " elements";
    if (count == 2 && first.ascending == edges[groups[g] + 1].ascending) {
      wrong = name + " has both elements on one side";
    }
  }
  return checks.add(tag + ".conforming", wrong.empty(), wrong);
}

bool check_mid_nodes(const MeshData& mesh,
                     const std::vector<HalfEdge>& edges,
                     const std::vector<std::size_t>& groups,
                     const std::string& tag,
                     Checks& checks) {
  std::string wrong;
  double worst = 0;
  for (std::size_t g = 0; g + 1 < groups.size() && wrong.empty(); ++g) {
    const HalfEdge& e = edges[groups[g]];
    const std::string name = "edge " + std::to_string(e.low) + "-" + std::to_string(e.high);
    for (std::size_t i = groups[g]; i < groups[g + 1]; ++i) {
      if (edges[i].mid != e.mid) wrong = name + " has two mid nodes";
    }
    const Point2 a = planar(mesh.points[static_cast<std::size_t>(e.low)]);
    const Point2 b = planar(mesh.points[static_cast<std::size_t>(e.high)]);
    const Point2 m = planar(mesh.points[static_cast<std::size_t>(e.mid)]);
    const double off = distance(0.5 * (a + b), m) / std::max(distance(a, b), 1e-300);
    worst = std::max(worst, off);
    if (off > kMidTolerance) wrong = name + ": its mid node is off by " + shown(off) + " of it";
  }
  return checks.add(tag + ".mid_nodes", wrong.empty(),
                    wrong.empty() ? "farthest from a midpoint: " + shown(worst) : wrong);
}

}  // namespace

std::vector<HalfEdge> sorted_edges(const MeshData& mesh) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  std::vector<HalfEdge> edges;
  edges.reserve(mesh.element_count() * 3);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const std::int32_t* nodes = &mesh.elements[e * k];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = nodes[i];
      const std::int32_t b = nodes[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b, static_cast<std::int32_t>(e),
                       mesh.order == 2 ? nodes[3 + i] : -1});
    }
  }
  std::ranges::sort(edges, {},
                    [](const HalfEdge& e) { return std::tuple(e.low, e.high, e.element); });
  return edges;
}

std::vector<std::size_t> edge_groups(const std::vector<HalfEdge>& edges) {
  std::vector<std::size_t> groups;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool begins =
        i == 0 || edges[i].low != edges[i - 1].low || edges[i].high != edges[i - 1].high;
    if (begins) groups.push_back(i);
  }
  groups.push_back(edges.size());
  return groups;
}

double total_area(const MeshData& mesh) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const Point2 a = corner(mesh, e, 0);
    sum += 0.5 * cross(corner(mesh, e, 1) - a, corner(mesh, e, 2) - a);
  }
  return sum;
}

double diameter(const std::vector<Point3>& points) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Point2 low{kFar, kFar};
  Point2 high{-kFar, -kFar};
  for (const Point3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return points.empty() ? 0 : distance(low, high);
}

std::string shown(double value) {
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, 4).ptr;
  return {text, end};
}

bool Checks::add(std::string name, bool holds, std::string detail) {
  report_->checks.push_back(
      {std::move(name), holds ? Check::Status::kPass : Check::Status::kFail, std::move(detail)});
  return holds;
}

void Checks::skip(std::string name, std::string why) {
  report_->checks.push_back({std::move(name), Check::Status::kSkip, std::move(why)});
}

bool check_elements(const MeshData& mesh, const std::string& tag, double size, Checks& checks) {
  if (!check_fields(mesh, tag, checks)) return false;
  if (!check_corners(mesh, tag, checks)) return false;
  bool ok = check_orientation(mesh, tag, checks);
  ok &= check_duplicates(mesh, tag, size, checks);
  const std::vector<HalfEdge> edges = sorted_edges(mesh);
  const std::vector<std::size_t> groups = edge_groups(edges);
  ok &= check_conforming(edges, groups, tag, checks);
  if (mesh.order == 2) ok &= check_mid_nodes(mesh, edges, groups, tag, checks);
  return ok;
}

}  // namespace internal
}  // namespace symcell
