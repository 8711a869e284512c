#include <algorithm>
#include <charconv>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/cells/verify_support.hpp"
#include "core/geometry/predicates.hpp"
#include "core/geometry/predicates_3.hpp"

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
constexpr double kFar = std::numeric_limits<double>::infinity();
// An axis whose squared length is farther from 1 was not written as a unit vector.
constexpr double kUnitTolerance = 1e-9;
// Nodes closer than this share of the diameter are one node written twice.
constexpr double kDuplicateTolerance = 1e-10;

bool check_fields(const MeshData& mesh, const std::string& tag, Checks& checks) {
  std::string wrong;
  const Point3& u = mesh.axis_direction;
  const bool plane = mesh.dimension == 2;
  if (mesh.fold < 1) wrong = "fold " + std::to_string(mesh.fold) + " is below 1";
  if (plane && (u.x != 0 || u.y != 0 || std::abs(u.z) != 1)) {
    wrong = "the axis is not normal to the plane";
  }
  const Point3& o = mesh.axis_origin;
  if (!(std::abs(squared_length(u) - 1) <= kUnitTolerance) || !std::isfinite(o.x + o.y + o.z)) {
    wrong = "the axis is no point and unit vector";
  }
  if (mesh.elements.empty()) wrong = "no elements";
  for (std::size_t i = 0; i < mesh.points.size() && wrong.empty(); ++i) {
    const Point3& p = mesh.points[i];
    const bool fits =
        std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && (!plane || p.z == 0);
    if (!fits) {
      wrong = "node " + std::to_string(i) + " is not finite" +
              (plane ? " or not in the plane z = 0" : "");
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
    const std::array<Point3, 4> p = corners_of(mesh, e);
    const Sign sign = mesh.dimension == 2 ? orientation(planar(p[0]), planar(p[1]), planar(p[2]))
                                          : orientation_3(p[0], p[1], p[2], p[3]);
    if (sign == Sign::kPositive) continue;
    ++bad;
    first = e;
  }
  return checks.add(tag + ".orientation", bad == 0,
                    bad == 0 ? ""
                             : std::to_string(bad) + " elements are flat or turned over, first " +
                                   std::to_string(first));
}

// Sorted into columns wider than the tolerance, along z in space and along y in the plane, close
// nodes stand side by side; further passes shift the columns, for pairs that a border parts.
bool check_duplicates(const MeshData& mesh,
                      const std::string& tag,
                      double diameter,
                      Checks& checks) {
  const double tolerance = kDuplicateTolerance * diameter;
  const double width = std::max(4 * tolerance, std::numeric_limits<double>::min());
  const bool plane = mesh.dimension == 2;
  Point3 low{kFar, kFar, kFar};
  for (const Point3& p : mesh.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  }
  struct Place {
    double column_x, column_y, along;
    std::size_t node;
    [[nodiscard]] auto key() const { return std::tuple(column_x, column_y, along, node); }
  };
  std::vector<Place> order(mesh.points.size());
  std::string wrong;
  const auto pass = [&](double shift_x, double shift_y) {
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Point3& p = mesh.points[i];
      order[i] = {std::floor((p.x - low.x) / width + shift_x),
                  plane ? 0 : std::floor((p.y - low.y) / width + shift_y), plane ? p.y : p.z, i};
    }
    std::ranges::sort(order, {}, &Place::key);
    for (std::size_t i = 0; i < order.size() && wrong.empty(); ++i) {
      const Place& first = order[i];
      const Point3& p = mesh.points[first.node];
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        const Place& second = order[j];
        if (second.column_x != first.column_x || second.column_y != first.column_y) break;
        if (second.along - first.along > tolerance) break;
        const Point3& q = mesh.points[second.node];
        if (std::abs(q.x - p.x) > tolerance || std::abs(q.y - p.y) > tolerance) continue;
        wrong = "nodes " + std::to_string(first.node) + " and " + std::to_string(second.node) +
                " coincide";
        break;
      }
    }
  };
  for (const double shift_x : {0.0, 0.5}) {
    pass(shift_x, 0);
    if (!plane) pass(shift_x, 0.5);
  }
  return checks.add(tag + ".duplicates", wrong.empty(), wrong);
}

bool check_conforming(const MeshData& mesh, const std::string& tag, Checks& checks) {
  const std::vector<HalfFacet> facets = sorted_facets(mesh);
  const std::vector<std::size_t> groups = facet_groups(facets);
  std::string wrong;
  for (std::size_t g = 0; g + 1 < groups.size() && wrong.empty(); ++g) {
    const HalfFacet& first = facets[groups[g]];
    const std::size_t count = groups[g + 1] - groups[g];
    if (count > 2) {
      wrong = facet_name(first.nodes) + " has " + std::to_string(count) + " elements";
    }
    if (count == 2 && first.even == facets[groups[g] + 1].even) {
      wrong = facet_name(first.nodes) + " has both elements on one side";
    }
  }
  return checks.add(tag + ".conforming", wrong.empty(), wrong);
}

bool check_mid_nodes(const MeshData& mesh, const std::string& tag, Checks& checks) {
  std::string wrong;
  double worst = 0;
  const std::vector<ElementEdge> edges = element_edges(mesh);
  for (std::size_t i = 0; i < edges.size() && wrong.empty(); ++i) {
    const ElementEdge& e = edges[i];
    const std::string name = facet_name({e.low, e.high, -1});
    const bool twice = i > 0 && edges[i - 1].low == e.low && edges[i - 1].high == e.high;
    if (twice) wrong = name + " has two mid nodes";
    const Point3& a = mesh.points[static_cast<std::size_t>(e.low)];
    const Point3& b = mesh.points[static_cast<std::size_t>(e.high)];
    const Point3& m = mesh.points[static_cast<std::size_t>(e.mid)];
    const double off = distance(0.5 * (a + b), m) / std::max(distance(a, b), 1e-300);
    worst = std::max(worst, off);
    if (off > kMidTolerance) wrong = name + ": its mid node is off by " + shown(off) + " of it";
  }
  return checks.add(tag + ".mid_nodes", wrong.empty(),
                    wrong.empty() ? "farthest from a midpoint: " + shown(worst) : wrong);
}

// Facets of elements by their corners, in the order that runs counter-clockwise seen from outside;
// facet i lies opposite corner i.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
constexpr std::array<std::array<std::size_t, 2>, 3> kSides{{{1, 2}, {2, 0}, {0, 1}}};

}  // namespace

bool sort_facet(std::array<std::int32_t, 3>& nodes, std::int32_t dimension) {
  bool even = true;
  const auto exchange = [&](std::size_t i, std::size_t j) {
    if (nodes[i] < nodes[j]) return;
    std::swap(nodes[i], nodes[j]);
    even = !even;
  };
  exchange(0, 1);
  if (dimension == 2) return even;
  exchange(1, 2);
  exchange(0, 1);
  return even;
}

std::vector<HalfFacet> sorted_facets(const MeshData& mesh) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  const auto corners = static_cast<std::size_t>(mesh.dimension) + 1;
  std::vector<HalfFacet> facets;
  facets.reserve(mesh.element_count() * corners);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const std::int32_t* nodes = &mesh.elements[e * k];
    for (std::size_t i = 0; i < corners; ++i) {
      HalfFacet facet;
      if (mesh.dimension == 2) {
        facet.nodes = {nodes[kSides[i][0]], nodes[kSides[i][1]], -1};
      } else {
        facet.nodes = {nodes[kFaces[i][0]], nodes[kFaces[i][1]], nodes[kFaces[i][2]]};
      }
      facet.even = sort_facet(facet.nodes, mesh.dimension);
      facet.element = static_cast<std::int32_t>(e);
      facet.opposite = static_cast<std::int32_t>(i);
      facets.push_back(facet);
    }
  }
  std::ranges::sort(facets, [](const HalfFacet& a, const HalfFacet& b) {
    return a.nodes != b.nodes ? a.nodes < b.nodes : a.element < b.element;
  });
  return facets;
}

std::vector<std::size_t> facet_groups(const std::vector<HalfFacet>& facets) {
  std::vector<std::size_t> groups;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    if (i == 0 || facets[i].nodes != facets[i - 1].nodes) groups.push_back(i);
  }
  groups.push_back(facets.size());
  return groups;
}

std::string facet_name(const std::array<std::int32_t, 3>& nodes) {
  const std::string two = std::to_string(nodes[0]) + "-" + std::to_string(nodes[1]);
  return nodes[2] < 0 ? "edge " + two : "face " + two + "-" + std::to_string(nodes[2]);
}

std::span<const std::array<std::size_t, 2>> edge_corners(std::int32_t dimension) {
  static constexpr std::array<std::array<std::size_t, 2>, 3> kTriangle{{{0, 1}, {1, 2}, {2, 0}}};
  static constexpr std::array<std::array<std::size_t, 2>, 6> kTetrahedron{
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  if (dimension == 2) return kTriangle;
  return kTetrahedron;
}

std::vector<ElementEdge> element_edges(const MeshData& mesh) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  const auto pairs = edge_corners(mesh.dimension);
  const std::size_t corners = static_cast<std::size_t>(mesh.dimension) + 1;
  std::vector<ElementEdge> edges;
  edges.reserve(mesh.element_count() * pairs.size());
  for (std::size_t at = 0; at < mesh.elements.size(); at += k) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const std::int32_t a = mesh.elements[at + pairs[i][0]];
      const std::int32_t b = mesh.elements[at + pairs[i][1]];
      edges.push_back(
          {std::min(a, b), std::max(a, b), mesh.order == 2 ? mesh.elements[at + corners + i] : -1});
    }
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::array<Point3, 4> corners_of(const MeshData& mesh, std::size_t element) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  std::array<Point3, 4> p{};
  for (std::size_t i = 0; i <= static_cast<std::size_t>(mesh.dimension); ++i) {
    p[i] = mesh.points[static_cast<std::size_t>(mesh.elements[element * k + i])];
  }
  return p;
}

double total_measure(const MeshData& mesh) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const std::array<Point3, 4> p = corners_of(mesh, e);
    const Point3 normal = cross(p[1] - p[0], p[2] - p[0]);
    sum += mesh.dimension == 2 ? 0.5 * normal.z : dot(normal, p[3] - p[0]) / 6;
  }
  return sum;
}

double diameter(const std::vector<Point3>& points) {
  Point3 low{kFar, kFar, kFar};
  Point3 high{-kFar, -kFar, -kFar};
  for (const Point3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
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
  ok &= check_conforming(mesh, tag, checks);
  if (mesh.order == 2) ok &= check_mid_nodes(mesh, tag, checks);
  return ok;
}

}  // namespace internal
}  // namespace symcell
