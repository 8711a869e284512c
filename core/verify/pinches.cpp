// Pinches of a solid model: edges and vertices at which its material falls apart into parts that
// no face joins. A mesh of it must pinch there, and nowhere else.
//
// Round an edge, the triangles cut space into wedges, with material or not; runs of wedges with
// material that only triangles inside the material separate are one part. Round a vertex, a small
// sphere is cut by the arcs of the triangles: wedges at common edges join sides of triangles to the
// rims of regions. A region with several rims (a ring round a cone) is found by the shortest
// connection between the rims, which crosses nothing.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "core/base/index.hpp"
#include "core/verify/against_model.hpp"

namespace symcell::internal {
namespace {

// A triangle as seen along an edge, by its angle round it.
struct Spoke {
  double angle = 0;
  std::int32_t triangle = 0;
  bool forward = false;  // runs along the edge, and so looks towards growing angles

  // Side 2 t of triangle t is where its normal looks to, side 2 t + 1 the other.
  [[nodiscard]] std::int32_t side_ahead() const { return 2 * triangle + (forward ? 0 : 1); }
  [[nodiscard]] std::int32_t side_behind() const { return 2 * triangle + (forward ? 1 : 0); }
};

// Angles round an axis, from an arbitrary direction.
class AxisAngles {
 public:
  AxisAngles(const Point3& origin, const Point3& end) : origin_(origin), axis_(end - origin) {
    axis_ = (1 / length(axis_)) * axis_;
    const Point3 other = std::abs(axis_.x) < 0.5 ? Point3{1, 0, 0} : Point3{0, 1, 0};
    u_ = cross(axis_, other);
    v_ = cross(axis_, u_);
  }
  [[nodiscard]] double of(const Point3& p) const {
    return std::atan2(dot(p - origin_, v_), dot(p - origin_, u_));
  }

 private:
  Point3 origin_;
  Point3 axis_, u_, v_;
};

class ModelPinchFinder {
 public:
  explicit ModelPinchFinder(const SidedTriangles& solid)
      : solid_(solid),
        uses_(sorted_edge_uses(solid.triangles)),
        slots_(6 * solid.triangles.size()) {}

  ModelPinches run() {
    for_each_edge(uses_, [&](std::size_t begin, std::size_t end) { look_round_edge(begin, end); });
    join_through_material();
    look_at_vertices();
    return std::move(result_);
  }

 private:
  [[nodiscard]] const Point3& point(std::int32_t v) const { return solid_.points[at(v)]; }
  [[nodiscard]] bool material(std::int32_t side) const {
    return solid_.material[at(side / 2)][at(side % 2)];
  }
  // The side of a triangle at one of its corners.
  [[nodiscard]] std::int32_t slot(std::int32_t side, std::int32_t vertex) const {
    const Triangle& t = solid_.triangles[at(side / 2)];
    return 3 * side + static_cast<std::int32_t>(std::ranges::find(t, vertex) - t.begin());
  }

  [[nodiscard]] std::vector<Spoke> spokes_of(std::size_t begin, std::size_t end) const {
    const std::int32_t low = uses_[begin].low, high = uses_[begin].high;
    const AxisAngles angles(point(low), point(high));
    std::vector<Spoke> spokes;
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = solid_.triangles[at(uses_[i].triangle)];
      const Point3& apex = point(t[0] + t[1] + t[2] - low - high);
      spokes.push_back({angles.of(apex), uses_[i].triangle, uses_[i].forward});
    }
    std::ranges::sort(spokes, [](const Spoke& s, const Spoke& t) {
      return std::pair(s.angle, s.triangle) < std::pair(t.angle, t.triangle);
    });
    return spokes;
  }

  void look_round_edge(std::size_t begin, std::size_t end) {
    const std::vector<Spoke> spokes = spokes_of(begin, end);
    const std::int32_t low = uses_[begin].low, high = uses_[begin].high;
    std::size_t runs = 0;
    for (std::size_t i = 0; i < spokes.size(); ++i) {
      const Spoke& s = spokes[i];
      const Spoke& t = spokes[(i + 1) % spokes.size()];
      slots_.join(slot(s.side_ahead(), low), slot(t.side_behind(), low));
      slots_.join(slot(s.side_ahead(), high), slot(t.side_behind(), high));
      runs += material(s.side_ahead()) && !material(s.side_behind()) ? 1 : 0;
    }
    if (runs > 1) result_.edges.push_back({point(low), point(high)});
  }

  void join_through_material() {
    for (std::size_t t = 0; t < solid_.triangles.size(); ++t) {
      if (!solid_.material[t][0] || !solid_.material[t][1]) continue;
      const auto side = static_cast<std::int32_t>(2 * t);
      for (std::int32_t i = 0; i < 3; ++i) slots_.join(3 * side + i, 3 * (side + 1) + i);
    }
  }

  // Triangles at each vertex, and how many parts of material there are at least.
  void look_at_vertices() {
    std::vector<std::vector<std::int32_t>> around(solid_.points.size());
    for (std::size_t t = 0; t < solid_.triangles.size(); ++t) {
      for (const std::int32_t v : solid_.triangles[t]) {
        around[at(v)].push_back(static_cast<std::int32_t>(t));
      }
    }
    for (std::size_t v = 0; v < around.size(); ++v) {
      const auto vertex = static_cast<std::int32_t>(v);
      if (parts_at(vertex, around[v]) < 2) continue;
      join_rims(vertex, around[v]);
      if (parts_at(vertex, around[v]) > 1) result_.points.push_back(solid_.points[v]);
    }
  }

  [[nodiscard]] std::size_t parts_at(std::int32_t vertex,
                                     const std::vector<std::int32_t>& triangles) {
    std::vector<std::int32_t> roots;
    for (const std::int32_t t : triangles) {
      for (const std::int32_t side : {2 * t, 2 * t + 1}) {
        if (material(side)) roots.push_back(slots_.root(slot(side, vertex)));
      }
    }
    std::ranges::sort(roots);
    return static_cast<std::size_t>(std::unique(roots.begin(), roots.end()) - roots.begin());
  }

  // The arc that a triangle cuts out of the sphere round a vertex.
  struct Arc {
    std::int32_t triangle = 0;
    std::array<std::int32_t, 2> ends{};  // vertices of the model
    std::array<Point3, 2> directions;    // of unit length
    Point3 normal;                       // of the triangle, likewise
  };
  // A connection between two arcs: from an end of the first to the nearest place of the second.
  struct Bridge {
    double angle = 0;
    std::size_t from = 0, end = 0, to = 0;
  };

  [[nodiscard]] std::vector<Arc> arcs_at(std::int32_t vertex,
                                         const std::vector<std::int32_t>& triangles) const {
    std::vector<Arc> arcs;
    const Point3& centre = point(vertex);
    const auto unit = [](const Point3& d) { return (1 / length(d)) * d; };
    for (const std::int32_t t : triangles) {
      const Triangle& v = solid_.triangles[at(t)];
      const auto corner = at(slot(2 * t, vertex) - 6 * t);
      const std::int32_t a = v[(corner + 1) % 3], b = v[(corner + 2) % 3];
      const Point3 p = point(a) - centre, q = point(b) - centre;
      arcs.push_back({t, {a, b}, {unit(p), unit(q)}, unit(cross(p, q))});
    }
    return arcs;
  }

  static double angle_between(const Point3& p, const Point3& q) {
    return std::atan2(length(cross(p, q)), dot(p, q));
  }
  // Whether the place of the arc nearest to a direction is between its ends.
  static bool faces(const Arc& arc, const Point3& d) {
    return dot(cross(arc.normal, arc.directions[0]), d) > 0 &&
           dot(cross(arc.directions[1], arc.normal), d) > 0;
  }
  static double angle_to(const Arc& arc, const Point3& d) {
    if (faces(arc, d)) return std::abs(std::asin(std::clamp(dot(arc.normal, d), -1.0, 1.0)));
    return std::min(angle_between(arc.directions[0], d), angle_between(arc.directions[1], d));
  }

  void join_rims(std::int32_t vertex, const std::vector<std::int32_t>& triangles) {
    const std::vector<Arc> arcs = arcs_at(vertex, triangles);
    // Arcs that have ends in common are one net.
    UnionFind nets(arcs.size());
    std::map<std::int32_t, std::int32_t> first;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const auto index = static_cast<std::int32_t>(i);
      for (const std::int32_t end : arcs[i].ends) {
        nets.join(first.try_emplace(end, index).first->second, index);
      }
    }
    if (nets.class_count() == 1) return;
    std::vector<Bridge> bridges;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      for (std::size_t j = 0; j < arcs.size(); ++j) {
        const auto a = static_cast<std::int32_t>(i), b = static_cast<std::int32_t>(j);
        if (nets.root(a) == nets.root(b)) continue;
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
          bridges.push_back({angle_to(arcs[j], arcs[i].directions[end]), i, end, j});
        }
      }
    }
    // Of all bridges between separate nets the shortest crosses no third.
    std::ranges::stable_sort(bridges, {}, &Bridge::angle);
    for (const Bridge& b : bridges) {
      const auto from = static_cast<std::int32_t>(b.from), to = static_cast<std::int32_t>(b.to);
      if (nets.root(from) == nets.root(to)) continue;
      nets.join(from, to);
      join_over(vertex, arcs, b);
    }
  }

  // The two sides that look at each other over a bridge are rims of one region.
  void join_over(std::int32_t vertex, const std::vector<Arc>& arcs, const Bridge& bridge) {
    const Arc& from = arcs[bridge.from];
    const Arc& to = arcs[bridge.to];
    const Point3 start = from.directions[bridge.end];
    std::int32_t seen = 0;
    Point3 target;
    if (faces(to, start)) {
      const double above = dot(to.normal, start);
      seen = 2 * to.triangle + (above > 0 ? 0 : 1);
      target = start - above * to.normal;
    } else {
      const bool second =
          angle_between(to.directions[1], start) < angle_between(to.directions[0], start);
      target = to.directions[second ? 1 : 0];
      seen = side_towards(vertex, to.ends[second ? 1 : 0], start);
    }
    const std::int32_t own = side_towards(vertex, from.ends[bridge.end], target);
    slots_.join(slot(own, vertex), slot(seen, vertex));
  }

  // At the edge from the vertex to `end`: a side of the wedge that a direction from the vertex
  // looks into.
  [[nodiscard]] std::int32_t side_towards(std::int32_t vertex,
                                          std::int32_t end,
                                          const Point3& direction) const {
    const std::pair wanted(std::min(vertex, end), std::max(vertex, end));
    const auto begin = std::ranges::lower_bound(
        uses_, wanted, {}, [](const EdgeUse& use) { return std::pair(use.low, use.high); });
    auto stop = begin;
    while (stop != uses_.end() && std::pair(stop->low, stop->high) == wanted) ++stop;
    const std::vector<Spoke> spokes = spokes_of(static_cast<std::size_t>(begin - uses_.begin()),
                                                static_cast<std::size_t>(stop - uses_.begin()));
    const AxisAngles angles(point(wanted.first), point(wanted.second));
    // Only what is square to the edge counts, so any origin on it will do.
    const double angle = angles.of(point(wanted.first) + direction);
    const auto next = std::ranges::upper_bound(spokes, angle, {}, &Spoke::angle);
    return (next == spokes.begin() ? spokes.back() : *std::prev(next)).side_ahead();
  }

  const SidedTriangles& solid_;
  std::vector<EdgeUse> uses_;
  UnionFind slots_;  // sides of triangles at their corners
  ModelPinches result_;
};

}  // namespace

ModelPinches find_model_pinches(const SidedTriangles& solid) {
  return ModelPinchFinder(solid).run();
}

}  // namespace symcell::internal
