#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "core/geometry/predicates.hpp"
#include "core/geometry/predicates_3.hpp"
#include "core/verify/support.hpp"

namespace symcell::internal {
namespace {

// Of an edge: by which its mid node may lie beside it, on an arc of 60 degrees.
constexpr double kArcTolerance = 0.14;
// Of an edge: likewise beside it, on a curved face.
constexpr double kFaceTolerance = 0.16;
// Mid nodes farther from the midpoint than this share of the edge are refused.
constexpr double kMidTolerance = 1e-6;
// An axis whose squared length is farther from 1 was not written as a unit vector.
constexpr double kUnitTolerance = 1e-9;

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
                      double tolerance,
                      Checks& checks) {
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

bool check_conforming(const FacetedMesh& mesh, const std::string& tag, Checks& checks) {
  Flaws flaws;
  for (std::size_t g = 0; g < mesh.group_count(); ++g) {
    const auto name = [&] { return facet_name(mesh.first(g).nodes); };
    if (mesh.sides(g) > 2) {
      flaws.note([&] { return name() + " has " + std::to_string(mesh.sides(g)) + " elements"; });
    }
    if (mesh.sides(g) == 2 && mesh.first(g).even == mesh.second(g).even) {
      flaws.note([&] { return name() + " has both elements on one side"; });
    }
  }
  return flaws.report(checks, tag + ".conforming");
}

// Each mid node belongs to one edge and is no corner.
void note_shared_mid_nodes(const MeshData& mesh, std::vector<ElementEdge> edges, Flaws& flaws) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  const auto corners = static_cast<std::size_t>(mesh.dimension) + 1;
  std::vector<char> corner(mesh.points.size(), 0);
  for (std::size_t at = 0; at < mesh.elements.size(); at += k) {
    for (std::size_t i = 0; i < corners; ++i) {
      corner[static_cast<std::size_t>(mesh.elements[at + i])] = 1;
    }
  }
  std::ranges::sort(edges, {}, &ElementEdge::mid);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto mid = static_cast<std::size_t>(edges[i].mid);
    const std::string name = "mid node " + std::to_string(mid);
    if (corner[mid] != 0) flaws.note([&] { return name + " is a corner too"; });
    if (i > 0 && edges[i - 1].mid == edges[i].mid) {
      flaws.note([&] { return name + " belongs to two edges"; });
    }
  }
}

// On the bisector of its edge, and not far from it.
bool may_be_on_arc(const Point3& a, const Point3& m, const Point3& b) {
  const Point3 d = b - a, off = m - 0.5 * (a + b);
  const double size2 = dot(d, d);
  return std::abs(dot(off, d)) <= kMidTolerance * size2 &&
         dot(off, off) <= kArcTolerance * kArcTolerance * size2;
}

// Quadratic triangles whose Jacobian is not positive at all of their nodes.
void note_folded(const MeshData& mesh, Flaws& flaws) {
  constexpr double kNodes[6][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    Point2 p[6];
    for (std::size_t i = 0; i < 6; ++i) {
      const Point3& q = mesh.points[static_cast<std::size_t>(mesh.elements[6 * e + i])];
      p[i] = {q.x, q.y};
    }
    for (const auto& [r, s] : kNodes) {
      const double t = 1 - r - s;
      // Derivatives of the six shape functions along r and s.
      const double dr[6] = {1 - 4 * t, 4 * r - 1, 0, 4 * (t - r), 4 * s, -4 * s};
      const double ds[6] = {1 - 4 * t, 0, 4 * s - 1, -4 * r, 4 * r, 4 * (t - s)};
      Point2 along_r, along_s;
      for (std::size_t i = 0; i < 6; ++i) {
        along_r = along_r + dr[i] * p[i];
        along_s = along_s + ds[i] * p[i];
      }
      if (cross(along_r, along_s) > 0) continue;
      flaws.note([&] { return "element " + std::to_string(e) + " is folded"; });
      break;
    }
  }
}

// Quadratic tetrahedra whose Jacobian is not positive at nodes, the centroid and the points of the usual
// rule of four.
void note_folded_tetrahedra(const MeshData& mesh, Flaws& flaws) {
  constexpr double kA = 0.58541019662496852, kB = 0.1381966011250105;
  constexpr double kPlaces[15][4] = {{1, 0, 0, 0},
                                     {0, 1, 0, 0},
                                     {0, 0, 1, 0},
                                     {0, 0, 0, 1},
                                     {0.5, 0.5, 0, 0},
                                     {0, 0.5, 0.5, 0},
                                     {0.5, 0, 0.5, 0},
                                     {0.5, 0, 0, 0.5},
                                     {0, 0.5, 0, 0.5},
                                     {0, 0, 0.5, 0.5},
                                     {0.25, 0.25, 0.25, 0.25},
                                     {kA, kB, kB, kB},
                                     {kB, kA, kB, kB},
                                     {kB, kB, kA, kB},
                                     {kB, kB, kB, kA}};
  constexpr std::size_t kSides[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const auto node = [&](std::size_t i) -> const Point3& {
      return mesh.points[static_cast<std::size_t>(mesh.elements[10 * e + i])];
    };
    for (const auto& w : kPlaces) {
      // Derivatives by the four barycentric coordinates of w_i (2 w_i - 1) and 4 w_i w_j.
      Point3 by[4];
      for (std::size_t i = 0; i < 4; ++i) by[i] = (4 * w[i] - 1) * node(i);
      for (std::size_t s = 0; s < 6; ++s) {
        const auto [i, j] = kSides[s];
        by[i] = by[i] + 4 * w[j] * node(4 + s);
        by[j] = by[j] + 4 * w[i] * node(4 + s);
      }
      if (dot(cross(by[1] - by[0], by[2] - by[0]), by[3] - by[0]) > 0) continue;
      flaws.note([&] { return "element " + std::to_string(e) + " is folded"; });
      break;
    }
  }
}

// Edges of facets with one element alone, ascending.
std::vector<std::array<std::int32_t, 2>> outer_edges(const FacetedMesh& mesh) {
  std::vector<std::array<std::int32_t, 2>> edges;
  for (std::size_t g = 0; g < mesh.group_count(); ++g) {
    if (mesh.sides(g) != 1) continue;
    const auto& nodes = mesh.first(g).nodes;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = nodes[i], b = nodes[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::ranges::sort(edges);
  return edges;
}

bool check_mid_nodes(const FacetedMesh& faceted, const std::string& tag, Checks& checks) {
  const MeshData& mesh = faceted.mesh;
  const auto outer =
      mesh.dimension == 3 ? outer_edges(faceted) : std::vector<std::array<std::int32_t, 2>>{};
  Flaws flaws;
  double worst = 0;
  const std::vector<ElementEdge> edges = element_edges(mesh);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const ElementEdge& e = edges[i];
    const auto name = [&] { return facet_name({e.low, e.high, -1}); };
    const bool twice = i > 0 && edges[i - 1].low == e.low && edges[i - 1].high == e.high;
    if (twice) flaws.note([&] { return name() + " has two mid nodes"; });
    const Point3& a = mesh.points[static_cast<std::size_t>(e.low)];
    const Point3& b = mesh.points[static_cast<std::size_t>(e.high)];
    const Point3& m = mesh.points[static_cast<std::size_t>(e.mid)];
    // Edges without length are found as coinciding nodes; the least divisor keeps 0 / 0 away.
    const double off =
        distance(0.5 * (a + b), m) / std::max(distance(a, b), std::numeric_limits<double>::min());
    worst = std::max(worst, off);
    // Of a solid only edges of its boundary may follow curved faces.
    const bool may_be_off = mesh.dimension == 2
                                ? may_be_on_arc(a, m, b)
                                : mesh.curved && off <= kFaceTolerance &&
                                      std::ranges::binary_search(outer, std::array{e.low, e.high});
    if (off > kMidTolerance && !may_be_off) {
      flaws.note([&] { return name() + ": its mid node is off by " + shown(off) + " of it"; });
    }
  }
  if (worst > kMidTolerance) {
    mesh.dimension == 2 ? note_folded(mesh, flaws) : note_folded_tetrahedra(mesh, flaws);
  }
  note_shared_mid_nodes(mesh, edges, flaws);
  return flaws.report(checks, tag + ".mid_nodes", "farthest from a midpoint: " + shown(worst));
}

}  // namespace

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
  if (mesh.single_precision) wrong = "coordinates are not of 64 bits";
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

bool check_elements(const FacetedMesh& mesh,
                    const std::string& tag,
                    double tolerance,
                    Checks& checks) {
  if (!check_corners(mesh.mesh, tag, checks)) return false;
  bool ok = check_orientation(mesh.mesh, tag, checks);
  ok &= check_duplicates(mesh.mesh, tag, tolerance, checks);
  ok &= check_conforming(mesh, tag, checks);
  if (mesh.mesh.order == 2) ok &= check_mid_nodes(mesh, tag, checks);
  return ok;
}

}  // namespace symcell::internal
