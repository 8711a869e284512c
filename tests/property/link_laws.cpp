#include "tests/property/link_laws.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "core/cell/full_mesh.hpp"
#include "core/geometry/point_tree.hpp"
#include "tests/property/link_fans.hpp"

namespace symcell {
namespace {

using Tet = std::array<std::int64_t, 4>;
using Edge = std::pair<std::int64_t, std::int64_t>;
using Face = std::array<std::int64_t, 3>;

std::size_t idx(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

// Nodes and edges whose elements do not hang together, and the faces of one element.
struct Links {
  std::vector<std::int64_t> nodes;
  std::vector<Edge> edges;
  std::vector<Face> outer;
};

Links links_of(const std::vector<Tet>& tets) {
  std::vector<std::pair<Face, std::size_t>> faces;
  Fans<std::int64_t> nodes;
  Fans<Edge> edges;
  for (std::size_t t = 0; t < tets.size(); ++t) {
    Tet v = tets[t];
    std::sort(v.begin(), v.end());
    for (std::size_t i = 0; i < 4; ++i) {
      nodes.add(v[i], t);
      for (std::size_t j = i + 1; j < 4; ++j) edges.add({v[i], v[j]}, t);
      faces.push_back({{v[i == 0 ? 1 : 0], v[i <= 1 ? 2 : 1], v[i <= 2 ? 3 : 2]}, t});
    }
  }
  nodes.finish();
  edges.finish();
  std::sort(faces.begin(), faces.end());
  Links result;
  for (std::size_t i = 0; i < faces.size();) {
    const Face f = faces[i].first;
    if (i + 1 == faces.size() || faces[i + 1].first != f) {
      result.outer.push_back(f);
      ++i;
      continue;
    }
    const std::size_t a = faces[i].second, b = faces[i + 1].second;
    for (const std::int64_t node : f) nodes.join(node, a, b);
    for (const Edge& e : {Edge{f[0], f[1]}, Edge{f[1], f[2]}, Edge{f[0], f[2]}}) {
      edges.join(e, a, b);
    }
    i += 2;
  }
  result.nodes = nodes.parted();
  result.edges = edges.parted();
  return result;
}

double distance_to_segment(Point3 p, Point3 a, Point3 b) {
  const Point3 u = b - a;
  const double t = std::clamp(dot(p - a, u) / squared_length(u), 0.0, 1.0);
  return distance(p, a + t * u);
}

// From a point to a triangle that has an area.
double distance_to_triangle(Point3 p, Point3 a, Point3 b, Point3 c) {
  const Point3 normal = cross(b - a, c - a);
  const bool inside = dot(cross(b - a, p - a), normal) >= 0 &&
                      dot(cross(c - b, p - b), normal) >= 0 &&
                      dot(cross(a - c, p - c), normal) >= 0;
  if (inside) return std::abs(dot(p - a, normal)) / length(normal);
  return std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

class LinkLaws {
 public:
  LinkLaws(const SymmetryCellMesh& cell, const ModelTopology& model)
      : model_(model), cell_(cell), view_(cell) {
    for (std::int64_t i = 0; i < view_.node_count(); ++i) {
      points_.push_back(view_.position(view_.node(i)));
    }
    const auto stride = idx(cell.nodes_per_element);
    for (std::int32_t s = 0; s < cell.fold; ++s) {
      for (std::size_t e = 0; e < cell.element_count(); ++e) {
        Tet tet{}, own{};
        for (std::size_t i = 0; i < 4; ++i) {
          own[i] = cell.elements[stride * e + i];
          tet[i] = view_.node_id(idx(own[i]), s);
        }
        tets_.push_back(tet);
        if (s == 0) cell_tets_.push_back(own);
      }
    }
  }

  std::vector<std::string> run() {
    full_ = links_of(tets_);
    check_full();
    check_cell();
    check_rim();
    check_topology();
    check_hanging();
    return std::move(broken_);
  }

 private:
  template <class... Parts>
  void broken(const Parts&... parts) {
    broken_.push_back(law_text(parts...));
  }
  [[nodiscard]] Point3 at(std::int64_t node) const { return points_[idx(node)]; }
  [[nodiscard]] double tolerance() const { return kPinchTolerance * model_.diameter; }
  [[nodiscard]] std::string place(std::int64_t node) const {
    const Point3 p = at(node);
    return law_text(node, " at (", p.x, ", ", p.y, ", ", p.z, ")");
  }

  // An edge may run over the ends of several pieces of one straight pinch.
  [[nodiscard]] bool pinched(const Edge& e) const {
    const auto on_pinch = [&](Point3 p) {
      return std::any_of(model_.pinches.edges.begin(), model_.pinches.edges.end(),
                         [&](const auto& pinch) {
                           return distance_to_segment(p, pinch[0], pinch[1]) <= tolerance();
                         });
    };
    const Point3 a = at(e.first), b = at(e.second);
    return on_pinch(a) && on_pinch(b) && on_pinch(0.5 * (a + b));
  }
  [[nodiscard]] bool pinched(std::int64_t node) const {
    return pinched(Edge{node, node}) ||
           std::any_of(model_.pinches.points.begin(), model_.pinches.points.end(),
                       [&](Point3 p) { return distance(p, at(node)) <= tolerance(); });
  }

  void check_full() {
    std::erase_if(full_.nodes, [&](std::int64_t n) { return pinched(n); });
    std::erase_if(full_.edges, [&](const Edge& e) { return pinched(e); });
    if (!full_.nodes.empty()) {
      broken("links: at ", full_.nodes.size(), " nodes of the full mesh elements do not hang ",
             "together, the first is ", place(full_.nodes.front()));
    }
    if (!full_.edges.empty()) {
      broken("links: at ", full_.edges.size(), " edges of the full mesh elements do not hang ",
             "together, the first is from node ", place(full_.edges.front().first), " to ",
             place(full_.edges.front().second));
    }
  }

  void check_cell() {
    Links own = links_of(cell_tets_);
    const std::set<std::int64_t> bad_nodes(full_.nodes.begin(), full_.nodes.end());
    const std::set<Edge> bad_edges(full_.edges.begin(), full_.edges.end());
    const auto id = [&](std::int64_t node) { return view_.node_id(idx(node), 0); };
    std::erase_if(own.nodes,
                  [&](std::int64_t n) { return pinched(id(n)) || bad_nodes.contains(id(n)); });
    std::erase_if(own.edges, [&](const Edge& e) {
      const Edge full = std::minmax({id(e.first), id(e.second)});
      return pinched(full) || bad_edges.contains(full);
    });
    if (!own.nodes.empty()) {
      broken("links: at ", own.nodes.size(), " nodes of the cell elements do not hang together as ",
             "they do in the full mesh, the first is ", place(id(own.nodes.front())));
    }
    if (!own.edges.empty()) {
      broken("links: at ", own.edges.size(), " edges of the cell elements do not hang together as ",
             "they do in the full mesh, the first is from node ",
             place(id(own.edges.front().first)), " to ", place(id(own.edges.front().second)));
    }
  }

  void check_rim() {
    std::map<Edge, int> faces;
    for (const Face& f : full_.outer) {
      for (const Edge& e : {Edge{f[0], f[1]}, Edge{f[1], f[2]}, Edge{f[0], f[2]}}) ++faces[e];
    }
    std::erase_if(faces, [&](const auto& f) {
      return f.second == 2 || (f.second % 2 == 0 && pinched(f.first));
    });
    if (faces.empty()) return;
    const auto& [edge, count] = *faces.begin();
    broken("rim: ", faces.size(), " edges have not two faces of the boundary, the first is from ",
           place(edge.first), " to ", place(edge.second), " with ", count);
  }

  void check_topology() {
    if (!model_.boundary) return;
    const test::BoundaryTopology found = test::boundary_topology(full_.outer);
    if (found.pieces != model_.boundary->pieces) {
      broken("topology: the boundary has ", found.pieces, " pieces instead of ",
             model_.boundary->pieces);
    }
    if (found.euler != model_.boundary->euler) {
      broken("topology: vertices - edges + faces of the boundary is ", found.euler, " instead of ",
             model_.boundary->euler);
    }
  }

  void check_hanging() {
    const PointTree tree(points_);
    const double reach = kHanging * model_.diameter;
    const Point3 margin{reach, reach, reach};
    std::size_t count = 0;
    for (const Face& f : full_.outer) {
      const Point3 a = at(f[0]), b = at(f[1]), c = at(f[2]);
      const Point3 low{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}),
                       std::min({a.z, b.z, c.z})};
      const Point3 high{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}),
                        std::max({a.z, b.z, c.z})};
      tree.within_box(low - margin, high + margin, [&](std::int32_t n) {
        if (n == f[0] || n == f[1] || n == f[2]) return;
        if (distance_to_triangle(at(n), a, b, c) > reach) return;
        if (count++ > 0) return;
        broken("hanging: node ", place(n), " lies in a face of the boundary, that of ", place(f[0]),
               ", ", place(f[1]), ", ", place(f[2]));
      });
    }
    if (count > 1) broken("hanging: there are ", count, " such places");
  }

  const ModelTopology& model_;
  const SymmetryCellMesh& cell_;
  FullMeshView view_;
  std::vector<Point3> points_;
  std::vector<Tet> tets_;
  std::vector<Tet> cell_tets_;  // by nodes of the cell
  Links full_;
  std::vector<std::string> broken_;
};

}  // namespace

std::vector<std::string> broken_link_laws(const SymmetryCellMesh& cell,
                                          const ModelTopology& model) {
  return LinkLaws(cell, model).run();
}

}  // namespace symcell
