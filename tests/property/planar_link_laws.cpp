#include "tests/property/planar_link_laws.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "core/cell/full_mesh.hpp"
#include "core/geometry/point_tree.hpp"
#include "tests/property/link_fans.hpp"
#include "tests/property/restored_mesh.hpp"

namespace symcell {
namespace {

using Triangles = std::vector<std::array<std::int32_t, 3>>;
using Edge = std::array<std::int64_t, 2>;

std::size_t idx(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

std::map<Edge, std::vector<std::size_t>> triangles_at_edges(const Triangles& triangles) {
  std::map<Edge, std::vector<std::size_t>> result;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax({triangles[t][i], triangles[t][(i + 1) % 3]});
      result[{low, high}].push_back(t);
    }
  }
  return result;
}

// Nodes whose triangles do not hang together.
std::set<std::int64_t> parted_nodes(const Triangles& triangles) {
  Fans<std::int64_t> fans;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::int64_t node : triangles[t]) fans.add(node, t);
  }
  fans.finish();
  for (const auto& [edge, both] : triangles_at_edges(triangles)) {
    if (both.size() != 2) continue;
    for (const std::int64_t node : edge) fans.join(node, both[0], both[1]);
  }
  const std::vector<std::int64_t> parted = fans.parted();
  return {parted.begin(), parted.end()};
}

class PlanarLinkLaws {
 public:
  PlanarLinkLaws(const SymmetryCellMesh& cell, const PlanarTopology& model)
      : model_(model), cell_(cell), mesh_(restore(cell)) {
    for (const auto& [edge, both] : triangles_at_edges(mesh_.triangles)) {
      if (both.size() == 1) rim_.push_back(edge);
    }
  }

  std::vector<std::string> run() {
    check_links();
    check_rim();
    check_hanging();
    return std::move(broken_);
  }

 private:
  template <class... Parts>
  void broken(const Parts&... parts) {
    broken_.push_back(law_text(parts...));
  }
  [[nodiscard]] Point2 at(std::int64_t node) const { return mesh_.points[idx(node)]; }
  [[nodiscard]] bool pinched(std::int64_t node) const {
    return std::any_of(model_.pinches.begin(), model_.pinches.end(), [&](Point2 p) {
      return distance(p, at(node)) <= kPinchTolerance * model_.diameter;
    });
  }

  void check_links() {
    const std::set<std::int64_t> full = parted_nodes(mesh_.triangles);
    for (const std::int64_t n : full) {
      if (pinched(n)) continue;
      broken("links: the triangles round node ", n, " at (", at(n).x, ", ", at(n).y,
             ") of the full mesh do not hang together");
      break;
    }
    Triangles own;
    for (std::size_t e = 0; e < cell_.element_count(); ++e) {
      auto& t = own.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) {
        t[i] = cell_.elements[idx(cell_.nodes_per_element) * e + i];
      }
    }
    const FullMeshView view(cell_);
    for (const std::int64_t n : parted_nodes(own)) {
      const std::int64_t id = view.node_id(idx(n), 0);
      if (full.contains(id) || pinched(id)) continue;
      broken("links: the triangles round node ", n, " at (", at(id).x, ", ", at(id).y,
             ") of the cell do not hang together as they do in the full mesh");
      break;
    }
  }

  void check_rim() {
    std::map<std::int64_t, int> edges;
    for (const Edge& e : rim_) {
      ++edges[e[0]];
      ++edges[e[1]];
    }
    for (const auto& [node, count] : edges) {
      if (count == 2 || (count % 2 == 0 && pinched(node))) continue;
      broken("rim: node ", node, " at (", at(node).x, ", ", at(node).y, ") has ", count,
             " edges of the boundary");
      break;
    }
    if (!model_.boundary) return;
    const test::BoundaryTopology found = test::boundary_topology(rim_);
    if (found == *model_.boundary) return;
    broken("topology: the boundary has ", found.pieces, " pieces, vertices - edges is ",
           found.euler, " instead of ", model_.boundary->pieces, " and ", model_.boundary->euler);
  }

  void check_hanging() {
    std::vector<Point3> points;
    for (const Point2 p : mesh_.points) points.push_back({p.x, p.y, 0});
    const PointTree tree(points);
    const double reach = kHanging * model_.diameter;
    for (const Edge& e : rim_) {
      const Point2 a = at(e[0]), b = at(e[1]);
      bool found = false;
      tree.within_box({std::min(a.x, b.x) - reach, std::min(a.y, b.y) - reach, 0},
                      {std::max(a.x, b.x) + reach, std::max(a.y, b.y) + reach, 0},
                      [&](std::int32_t n) {
                        if (n == e[0] || n == e[1]) return;
                        const Point2 u = b - a, d = at(n) - a;
                        const double t = std::clamp(dot(d, u) / squared_length(u), 0.0, 1.0);
                        found = found || length(d - t * u) <= reach;
                      });
      if (!found) continue;
      broken("hanging: a node lies within the edge of the boundary from node ", e[0], " to ", e[1]);
      break;
    }
  }

  const PlanarTopology& model_;
  const SymmetryCellMesh& cell_;
  RestoredMesh mesh_;
  std::vector<Edge> rim_;
  std::vector<std::string> broken_;
};

}  // namespace

std::vector<std::string> broken_planar_link_laws(const SymmetryCellMesh& cell,
                                                 const PlanarTopology& model) {
  return PlanarLinkLaws(cell, model).run();
}

}  // namespace symcell
