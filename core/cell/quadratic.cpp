#include "core/cell/quadratic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>

#include "core/base/assert.hpp"
#include "core/cell/edge_orbit.hpp"
#include "core/cell/pair_images.hpp"
#include "core/geometry/arc.hpp"

namespace symcell {
namespace {

bool is_on_axis(const SymmetryCellMesh& mesh, OrbitVertex v) {
  return mesh.fold > 1 && mesh.on_axis[static_cast<std::size_t>(v.orbit)] != 0;
}

class Elevation {
 public:
  Elevation(const SymmetryCellMesh& mesh, std::span<const CurvedSide> sides)
      : mesh_(mesh), rotations_(mesh.fold), result_(mesh) {
    for (const CurvedSide& s : sides) {
      const TurnedEdge edge = turned(mesh.nodes[static_cast<std::size_t>(s.a)],
                                     mesh.nodes[static_cast<std::size_t>(s.b)]);
      middles_.emplace_back(edge.key,
                            rotations_.rotate(s.middle, rotations_.subtract(0, edge.turn)));
    }
    std::ranges::sort(middles_, {}, &std::pair<EdgeOrbit, Point3>::first);
  }

  SymmetryCellMesh run() {
    collect_edges();
    find_arcs();
    add_orbits();
    add_nodes();
    result_.order = 2;
    result_.nodes_per_element = mesh_.dimension == 2 ? 6 : 10;
    result_.nodes_per_facet = mesh_.dimension == 2 ? 3 : 6;
    result_.elements = with_mid_nodes(mesh_.elements, mesh_.nodes_per_element);
    result_.boundary = with_mid_nodes(mesh_.boundary, mesh_.nodes_per_facet);
    result_.lower_facets = with_mid_nodes(mesh_.lower_facets, mesh_.nodes_per_facet);
    result_.higher_facets = with_mid_nodes(mesh_.higher_facets, mesh_.nodes_per_facet);
    mark_nodes();
    pair_bounds();
    result_.boundary_bulges.clear();
    return std::move(result_);
  }

 private:
  struct Edge {
    TurnedEdge turned;
    std::int32_t low = 0;  // cell nodes, ascending
    std::int32_t high = 0;
    std::int32_t mid = -1;  // cell node
  };

  [[nodiscard]] bool on_axis(OrbitVertex v) const { return is_on_axis(mesh_, v); }
  [[nodiscard]] TurnedEdge turned(OrbitVertex a, OrbitVertex b) const {
    return turned_edge(mesh_, rotations_, a, b);
  }

  // Corner pairs in VTK's order of mid-side nodes; a triangle's third side runs 2-0, as in the
  // plane.
  static std::span<const std::array<std::size_t, 2>> sides(std::int32_t corners) {
    static constexpr std::array<std::array<std::size_t, 2>, 1> kSegment{{{0, 1}}};
    static constexpr std::array<std::array<std::size_t, 2>, 3> kTriangle{{{0, 1}, {1, 2}, {2, 0}}};
    static constexpr std::array<std::array<std::size_t, 2>, 6> kTetrahedron{
        {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
    if (corners == 2) return kSegment;
    if (corners == 3) return kTriangle;
    return kTetrahedron;
  }

  void collect_edges() {
    const auto k = static_cast<std::size_t>(mesh_.nodes_per_element);
    for (std::size_t e = 0; e < mesh_.elements.size(); e += k) {
      for (const auto& side : sides(mesh_.nodes_per_element)) {
        const std::int32_t a = mesh_.elements[e + side[0]];
        const std::int32_t b = mesh_.elements[e + side[1]];
        edges_.push_back({{}, std::min(a, b), std::max(a, b), -1});
      }
    }
    const auto by_nodes = [](const Edge& e) { return std::pair(e.low, e.high); };
    std::ranges::sort(edges_, {}, by_nodes);
    const auto same = [&](const Edge& a, const Edge& b) { return by_nodes(a) == by_nodes(b); };
    edges_.erase(std::unique(edges_.begin(), edges_.end(), same), edges_.end());
    for (Edge& e : edges_) {
      e.turned = turned(mesh_.nodes[static_cast<std::size_t>(e.low)],
                        mesh_.nodes[static_cast<std::size_t>(e.high)]);
    }
  }

  // Bulges of arcs from the first to the second end of an edge's key.
  void find_arcs() {
    const auto k = static_cast<std::size_t>(mesh_.nodes_per_facet);
    for (std::size_t f = 0; f < mesh_.boundary_bulges.size(); ++f) {
      const double bulge = mesh_.boundary_bulges[f];
      const OrbitVertex a = mesh_.nodes[static_cast<std::size_t>(mesh_.boundary[k * f])];
      const OrbitVertex b = mesh_.nodes[static_cast<std::size_t>(mesh_.boundary[k * f + 1])];
      const TurnedEdge edge = turned(a, b);
      const bool same = edge.key.orbit_a == a.orbit && (on_axis(a) || edge.turn == a.exponent);
      arcs_.emplace_back(edge.key, same ? bulge : -bulge);
    }
    // Facets on the bounds have two places; one that is straight makes the other straight.
    std::ranges::sort(arcs_, {},
                      [](const auto& arc) { return std::pair(arc.first, std::abs(arc.second)); });
  }

  [[nodiscard]] Point3 midpoint(const EdgeOrbit& key) const {
    const auto given =
        std::ranges::lower_bound(middles_, key, {}, &std::pair<EdgeOrbit, Point3>::first);
    if (given != middles_.end() && given->first == key) return given->second;
    const Point3& a = mesh_.orbit_points[static_cast<std::size_t>(key.orbit_a)];
    const Point3& b = mesh_.orbit_points[static_cast<std::size_t>(key.orbit_b)];
    const Point2 turned_b = rotations_.rotate(Point2{b.x, b.y}, key.relative);
    const auto arc = std::ranges::lower_bound(arcs_, key, {}, &std::pair<EdgeOrbit, double>::first);
    if (arc != arcs_.end() && arc->first == key) {
      const Point2 mid = arc_middle({a.x, a.y}, turned_b, arc->second);
      return {mid.x, mid.y, a.z};
    }
    return {0.5 * (a.x + turned_b.x), 0.5 * (a.y + turned_b.y), 0.5 * (a.z + b.z)};
  }

  // A mid node is on the axis if its edge lies on it, or is a diameter.
  [[nodiscard]] bool mid_on_axis(const EdgeOrbit& key) const {
    const auto axis = [&](std::int32_t orbit) { return on_axis({orbit, 0}); };
    if (axis(key.orbit_a) && axis(key.orbit_b)) return true;
    return key.orbit_a == key.orbit_b && 2 * key.relative == mesh_.fold;
  }

  // One orbit of mid nodes an orbit of edges, in the order of the edges' keys.
  void add_orbits() {
    by_key_.resize(edges_.size());
    for (std::size_t i = 0; i < edges_.size(); ++i) by_key_[i] = i;
    std::ranges::sort(by_key_, {}, [&](std::size_t i) {
      return std::tuple(edges_[i].turned.key, edges_[i].turned.turn, i);
    });
  }

  void add_nodes() {
    const Edge* previous = nullptr;
    for (const std::size_t i : by_key_) {
      Edge& edge = edges_[i];
      const bool known = previous != nullptr && previous->turned.key == edge.turned.key;
      const bool axis = mid_on_axis(edge.turned.key);
      if (!known) {
        Point3 mid = midpoint(edge.turned.key);
        if (axis) mid.x = mid.y = 0;
        result_.orbit_points.push_back(mid);
        result_.on_axis.push_back(axis ? 1 : 0);
      }
      const std::int32_t turn = axis ? 0 : edge.turned.turn;
      const auto orbit = static_cast<std::int32_t>(result_.orbit_points.size()) - 1;
      // Several edges of the cell never share a node, but diameters share the centre.
      if (known && result_.nodes.back() == OrbitVertex{orbit, turn}) {
        edge.mid = previous->mid;
      } else {
        edge.mid = static_cast<std::int32_t>(result_.nodes.size());
        result_.nodes.push_back({orbit, turn});
      }
      previous = &edge;
    }
    result_.node_markers.resize(result_.nodes.size(), 0);
    result_.lower_to_higher.resize(result_.nodes.size(), -1);
  }

  [[nodiscard]] std::int32_t mid_node(std::int32_t a, std::int32_t b) const {
    const std::pair wanted(std::min(a, b), std::max(a, b));
    const auto found = std::ranges::lower_bound(
        edges_, wanted, {}, [](const Edge& e) { return std::pair(e.low, e.high); });
    SYMCELL_ASSERT(found != edges_.end() && std::pair(found->low, found->high) == wanted);
    return found->mid;
  }

  [[nodiscard]] std::vector<std::int32_t> with_mid_nodes(const std::vector<std::int32_t>& simplices,
                                                         std::int32_t corners) const {
    const auto k = static_cast<std::size_t>(corners);
    std::vector<std::int32_t> result;
    result.reserve(simplices.size() / k * (k + sides(corners).size()));
    for (std::size_t s = 0; s < simplices.size(); s += k) {
      for (std::size_t i = 0; i < k; ++i) result.push_back(simplices[s + i]);
      for (const auto& side : sides(corners)) {
        result.push_back(mid_node(simplices[s + side[0]], simplices[s + side[1]]));
      }
    }
    return result;
  }

  // Mid nodes on boundary facets take their marker, the smallest but 0 where there are several;
  // copies of one orbit take the same.
  void mark_nodes() {
    std::vector<std::int32_t> marker_of_orbit(result_.orbit_points.size(), 0);
    const auto corners = static_cast<std::size_t>(mesh_.nodes_per_facet);
    const auto all = static_cast<std::size_t>(result_.nodes_per_facet);
    for (std::size_t b = 0; b < result_.boundary_markers.size(); ++b) {
      for (std::size_t i = corners; i < all; ++i) {
        const auto node = static_cast<std::size_t>(result_.boundary[b * all + i]);
        std::int32_t& marker = marker_of_orbit[static_cast<std::size_t>(result_.nodes[node].orbit)];
        const std::int32_t own = result_.boundary_markers[b];
        if (own != 0 && (marker == 0 || own < marker)) marker = own;
      }
    }
    for (std::size_t i = mesh_.nodes.size(); i < result_.nodes.size(); ++i) {
      result_.node_markers[i] = marker_of_orbit[static_cast<std::size_t>(result_.nodes[i].orbit)];
    }
  }

  void pair_bounds() {
    for (std::size_t i = 0; i < result_.lower_facets.size(); ++i) {
      result_.lower_to_higher[static_cast<std::size_t>(result_.lower_facets[i])] =
          result_.higher_facets[i];
    }
    if (mesh_.fold == 1) return;
    for (std::size_t i = mesh_.nodes.size(); i < result_.nodes.size(); ++i) {
      const auto orbit = static_cast<std::size_t>(result_.nodes[i].orbit);
      if (result_.on_axis[orbit] != 0) result_.lower_to_higher[i] = static_cast<std::int32_t>(i);
    }
    pair_beyond_bounds(result_);
  }

  const SymmetryCellMesh& mesh_;
  RotationTable rotations_;
  SymmetryCellMesh result_;
  std::vector<Edge> edges_;  // by nodes
  std::vector<std::pair<EdgeOrbit, double>> arcs_;
  std::vector<std::pair<EdgeOrbit, Point3>> middles_;  // of curved sides, by key
  std::vector<std::size_t> by_key_;                    // edges by key and turn
};

}  // namespace

TurnedEdge turned_edge(const SymmetryCellMesh& mesh,
                       const RotationTable& rotations,
                       OrbitVertex a,
                       OrbitVertex b) {
  // A node on the axis has one copy: the other corner alone gives the turn.
  if (is_on_axis(mesh, a)) std::swap(a, b);
  if (is_on_axis(mesh, a)) {
    if (b.orbit < a.orbit) std::swap(a, b);
    return {{a.orbit, b.orbit, 0}, 0};
  }
  if (is_on_axis(mesh, b)) return {{a.orbit, b.orbit, 0}, a.exponent};
  if (b.orbit < a.orbit) std::swap(a, b);
  const std::int32_t relative = rotations.subtract(b.exponent, a.exponent);
  if (a.orbit != b.orbit) return {{a.orbit, b.orbit, relative}, a.exponent};
  // Within one orbit the edge may be seen from either end; take the smaller step.
  const std::int32_t back = rotations.subtract(0, relative);
  if (back < relative) return {{a.orbit, b.orbit, back}, b.exponent};
  // A diameter (step n/2) is its own half turn: one of its two turns stands for both.
  if (back == relative) return {{a.orbit, b.orbit, back}, std::min(a.exponent, b.exponent)};
  return {{a.orbit, b.orbit, relative}, a.exponent};
}

SymmetryCellMesh elevate_to_quadratic(const SymmetryCellMesh& mesh,
                                      std::span<const CurvedSide> sides) {
  SYMCELL_ASSERT(mesh.order == 1);
  return Elevation(mesh, sides).run();
}

}  // namespace symcell
