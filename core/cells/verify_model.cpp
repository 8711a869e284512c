#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "core/cells/verify_support.hpp"
#include "core/geometry/predicates.hpp"

namespace symcell::internal {
namespace {

// Nodes by place, for looking up model vertices: sorted by x.
class NodeFinder {
 public:
  explicit NodeFinder(const std::vector<Point3>& points) : points_(points), order_(points.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::int32_t>(i);
    std::ranges::sort(order_, {}, [&](std::int32_t i) { return x(i); });
  }

  // The nearest node within `tolerance`.
  [[nodiscard]] std::optional<std::int32_t> find(Point2 p, double tolerance) const {
    auto at =
        std::ranges::lower_bound(order_, p.x - tolerance, {}, [&](std::int32_t i) { return x(i); });
    std::optional<std::int32_t> best;
    double best_distance = tolerance;
    for (; at != order_.end() && x(*at) <= p.x + tolerance; ++at) {
      const double d = distance(planar(points_[static_cast<std::size_t>(*at)]), p);
      if (d > best_distance) continue;
      best = *at;
      best_distance = d;
    }
    return best;
  }

 private:
  [[nodiscard]] double x(std::int32_t i) const { return points_[static_cast<std::size_t>(i)].x; }

  const std::vector<Point3>& points_;
  std::vector<std::int32_t> order_;
};

class ModelChecker {
 public:
  ModelChecker(const FacetedMesh& full, const Pslg& model, double tolerance, Checks& checks)
      : full_(full.mesh),
        edges_(full.facets),
        groups_(full.groups),
        model_(model),
        tolerance_(tolerance),
        checks_(checks),
        constrained_(full.groups.size(), 0) {}

  std::vector<char> run() {
    collect_neighbours();
    if (!match_vertices()) return std::move(constrained_);
    cover_segments();
    check_points();
    check_boundary();
    check_region_borders();
    return std::move(constrained_);
  }

 private:
  [[nodiscard]] Point2 point(std::int32_t node) const {
    return planar(full_.points[static_cast<std::size_t>(node)]);
  }

  // Of each node, the groups of its edges.
  void collect_neighbours() {
    first_.assign(full_.points.size() + 1, 0);
    for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
      ++first_[static_cast<std::size_t>(edges_[groups_[g]].nodes[0]) + 1];
      ++first_[static_cast<std::size_t>(edges_[groups_[g]].nodes[1]) + 1];
    }
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    around_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
      around_[next[static_cast<std::size_t>(edges_[groups_[g]].nodes[0])]++] = g;
      around_[next[static_cast<std::size_t>(edges_[groups_[g]].nodes[1])]++] = g;
    }
  }

  // Vertices that no segment names need not be nodes; nor need those outside the meshed domain,
  // where a dangling segment may end: check_points looks at them.
  bool match_vertices() {
    const NodeFinder finder(full_.points);
    std::vector<char> named(model_.vertices.size(), 0);
    for (const PslgSegment& s : model_.segments) {
      for (const std::int32_t v : {s.a, s.b}) {
        if (v < 0 || static_cast<std::size_t>(v) >= named.size()) {
          return checks_.add("model.vertices", false,
                             "a segment names a vertex that does not exist");
        }
        named[static_cast<std::size_t>(v)] = 1;
      }
    }
    node_of_.assign(model_.vertices.size(), -1);
    for (std::size_t v = 0; v < named.size(); ++v) {
      const auto node = finder.find(model_.vertices[v], tolerance_);
      if (node) {
        node_of_[v] = *node;
      } else if (named[v] != 0) {
        points_.push_back({model_.vertices[v], Role::kVertex, v, false});
      }
    }
    return true;
  }

  // Walks from one end to the other along edges that lie on the segment.
  bool cover(const PslgSegment& segment) {
    std::int32_t at = node_of_[static_cast<std::size_t>(segment.a)];
    const std::int32_t end = node_of_[static_cast<std::size_t>(segment.b)];
    if (at < 0 || end < 0) return false;
    const Point2 b = model_.vertices[static_cast<std::size_t>(segment.b)];
    const Point2 a = model_.vertices[static_cast<std::size_t>(segment.a)];
    const double length = distance(a, b);
    if (!(length > 0)) return at == end;
    const Point2 along = (1 / length) * (b - a);
    while (at != end) {
      const double here = dot(point(at) - a, along);
      std::optional<std::size_t> step;
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t i = first_[static_cast<std::size_t>(at)];
           i < first_[static_cast<std::size_t>(at) + 1]; ++i) {
        const std::int32_t to = other_end(around_[i], at);
        const Point2 d = point(to) - a;
        const double ahead = dot(d, along) - here;
        if (std::abs(cross(along, d)) > tolerance_ || ahead <= 0 || ahead >= nearest) continue;
        nearest = ahead;
        step = around_[i];
      }
      if (!step || here + nearest > length + 2 * tolerance_) return false;
      constrained_[*step] = 1;
      at = other_end(*step, at);
    }
    return true;
  }

  [[nodiscard]] std::int32_t other_end(std::size_t group, std::int32_t node) const {
    const HalfFacet& e = edges_[groups_[group]];
    return e.nodes[0] == node ? e.nodes[1] : e.nodes[0];
  }

  // A segment that is no chain of edges must lie outside the meshed domain: samples of it tell.
  void cover_segments() {
    constexpr double kSamples[] = {0.137, 0.381, 0.5, 0.618, 0.893};
    for (std::size_t s = 0; s < model_.segments.size(); ++s) {
      if (cover(model_.segments[s])) continue;
      const Point2 a = model_.vertices[static_cast<std::size_t>(model_.segments[s].a)];
      const Point2 b = model_.vertices[static_cast<std::size_t>(model_.segments[s].b)];
      for (const double t : kSamples) {
        points_.push_back({a + t * (b - a), Role::kSegment, s, false});
      }
    }
  }

  void check_boundary() {
    std::string wrong;
    for (std::size_t g = 0; g + 1 < groups_.size() && wrong.empty(); ++g) {
      if (groups_[g + 1] - groups_[g] != 1 || constrained_[g] != 0) continue;
      const HalfFacet& e = edges_[groups_[g]];
      wrong = "boundary " + facet_name(e.nodes) + " of the mesh lies on no segment";
    }
    checks_.add("model.boundary", wrong.empty(), wrong);
  }

  void check_region_borders() {
    std::string wrong;
    for (std::size_t g = 0; g + 1 < groups_.size() && wrong.empty(); ++g) {
      if (groups_[g + 1] - groups_[g] != 2 || constrained_[g] != 0) continue;
      const HalfFacet& e = edges_[groups_[g]];
      const auto a = static_cast<std::size_t>(e.element);
      const auto b = static_cast<std::size_t>(edges_[groups_[g] + 1].element);
      if (full_.regions[a] == full_.regions[b]) continue;
      wrong = "the region changes across " + facet_name(e.nodes) + ", which is on no segment";
    }
    checks_.add("model.region_borders", wrong.empty(), wrong);
  }

  // Points of the model of which it matters whether an element is there.
  enum class Role : std::uint8_t { kVertex, kSegment, kHole, kRegion };
  struct ModelPoint {
    Point2 point;
    Role role = Role::kVertex;
    std::size_t index = 0;
    bool found = false;  // in an element
  };

  void check_points() {
    for (std::size_t i = 0; i < model_.holes.size(); ++i) {
      points_.push_back({model_.holes[i], Role::kHole, i, false});
    }
    for (std::size_t i = 0; i < model_.regions.size(); ++i) {
      points_.push_back({model_.regions[i].point, Role::kRegion, i, false});
    }
    std::ranges::sort(points_, {}, [](const ModelPoint& p) { return p.point.x; });
    for (std::size_t e = 0; e < full_.element_count() && !points_.empty(); ++e) find_points(e);
    for (const ModelPoint& p : points_) {
      if (p.role == Role::kRegion && !p.found) {
        wrong(Role::kRegion) = "no element at the seed of region " + std::to_string(p.index);
      }
    }
    static constexpr const char* kNames[] = {"model.vertices", "model.segments", "model.holes",
                                             "model.regions"};
    for (std::size_t role = 0; role < 4; ++role) {
      checks_.add(kNames[role], wrong_[role].empty(), wrong_[role]);
    }
  }

  // Marks the points in element `e` and tells what is wrong with them there.
  void find_points(std::size_t e) {
    const std::int32_t* nodes =
        &full_.elements[e * static_cast<std::size_t>(full_.nodes_per_element)];
    const Point2 a = point(nodes[0]);
    const Point2 b = point(nodes[1]);
    const Point2 c = point(nodes[2]);
    auto at = std::ranges::lower_bound(points_, std::min({a.x, b.x, c.x}), {},
                                       [](const ModelPoint& p) { return p.point.x; });
    const double right = std::max({a.x, b.x, c.x});
    for (; at != points_.end() && at->point.x <= right; ++at) {
      const Point2 p = at->point;
      const bool inside = orientation(a, b, p) != Sign::kNegative &&
                          orientation(b, c, p) != Sign::kNegative &&
                          orientation(c, a, p) != Sign::kNegative;
      if (!inside) continue;
      at->found = true;
      const std::string index = std::to_string(at->index);
      const std::string element = "element " + std::to_string(e);
      switch (at->role) {
        case Role::kVertex:
          wrong(at->role) = "vertex " + index + " of the model is no node but lies in " + element;
          break;
        case Role::kSegment:
          wrong(at->role) = "segment " + index + " of the model is no chain of edges in " + element;
          break;
        case Role::kHole: wrong(at->role) = element + " covers the seed of hole " + index; break;
        case Role::kRegion:
          if (full_.regions[e] == model_.regions[at->index].attribute) break;
          wrong(at->role) = element + " at the seed of region " + index + " has attribute " +
                            std::to_string(full_.regions[e]);
          break;
      }
    }
  }

  std::string& wrong(Role role) { return wrong_[static_cast<std::size_t>(role)]; }

  const MeshData& full_;
  const std::vector<HalfFacet>& edges_;
  const std::vector<std::size_t>& groups_;
  const Pslg& model_;
  double tolerance_;
  Checks& checks_;
  std::vector<char> constrained_;
  std::vector<std::size_t> first_;   // of each node in around_
  std::vector<std::size_t> around_;  // groups of edges
  std::vector<std::int32_t> node_of_;
  std::vector<ModelPoint> points_;
  std::array<std::string, 4> wrong_;  // by role
};

}  // namespace

std::vector<char> check_model(const FacetedMesh& full,
                              const Pslg& model,
                              double tolerance,
                              Checks& checks) {
  return ModelChecker(full, model, tolerance, checks).run();
}

}  // namespace symcell::internal
