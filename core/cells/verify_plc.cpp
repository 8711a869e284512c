#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "core/cells/verify_support.hpp"
#include "core/geometry/predicates_3.hpp"
#include "core/model/validate_plc.hpp"
#include "core/surface/triangle_tree.hpp"

namespace symcell::internal {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Where samples of a segment and of a triangle lie.
constexpr std::array<double, 5> kSegmentSamples{0.137, 0.381, 0.5, 0.618, 0.893};
constexpr std::array<std::array<double, 3>, 4> kTriangleSamples{
    {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.7, 0.2, 0.1}, {0.1, 0.7, 0.2}, {0.2, 0.1, 0.7}}};

class PlcChecker {
 public:
  PlcChecker(const FacetedMesh& full, const PlcComplex& model, double tolerance, Checks& checks)
      : full_(full),
        mesh_(full.mesh),
        model_(model),
        tolerance_(tolerance),
        checks_(checks),
        constrained_(full.groups.size(), 0) {}

  std::vector<char> run() {
    match_facets();
    cover_facets();
    match_vertices();
    cover_segments();
    check_points();
    check_boundary();
    check_region_borders();
    return std::move(constrained_);
  }

 private:
  using Triangles = std::vector<Triangle>;

  [[nodiscard]] const Point3& point(std::int32_t node) const {
    return mesh_.points[static_cast<std::size_t>(node)];
  }
  [[nodiscard]] std::array<Point3, 3> of_model(const Triangle& t) const {
    std::array<Point3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = model_.points[static_cast<std::size_t>(t[i])];
    return p;
  }

  // A face of the mesh lies on a facet if its corners do and its middle does.
  void match_facets() {
    Triangles triangles;
    for (const ComplexFacet& facet : model_.facets) {
      triangles.insert(triangles.end(), facet.triangles.triangles.begin(),
                       facet.triangles.triangles.end());
    }
    const TriangleTree tree(model_.points, triangles);
    std::vector<char> near(mesh_.points.size(), 0);
    for (std::size_t i = 0; i < near.size(); ++i) {
      near[i] = tree.within(mesh_.points[i], tolerance_) ? 1 : 0;
    }
    for (std::size_t g = 0; g < full_.group_count(); ++g) {
      const auto& nodes = full_.first(g).nodes;
      const bool all = std::ranges::all_of(
          nodes, [&](std::int32_t i) { return near[static_cast<std::size_t>(i)] != 0; });
      if (!all) continue;
      const std::array<Point3, 3> p = full_.triangle(g);
      const auto hit = tree.nearest((1.0 / 3) * (p[0] + p[1] + p[2]), tolerance_);
      if (hit.triangle < 0) continue;
      const auto q = of_model(triangles[static_cast<std::size_t>(hit.triangle)]);
      const Point3 normal = cross(q[1] - q[0], q[2] - q[0]);
      const double size = length(normal);
      const bool flat = std::ranges::all_of(p, [&](const Point3& corner) {
        return std::abs(dot(normal, corner - q[0])) <= 2 * tolerance_ * size;
      });
      if (flat) constrained_[g] = 1;
    }
  }

  // Samples of the facets are on such faces, or outside the meshed domain: check_points looks.
  void cover_facets() {
    Triangles faces;
    for (std::size_t g = 0; g < full_.group_count(); ++g) {
      if (constrained_[g] != 0) faces.push_back(full_.first(g).nodes);
    }
    const TriangleTree tree(mesh_.points, faces);
    for (const ComplexFacet& facet : model_.facets) {
      for (const Triangle& t : facet.triangles.triangles) {
        const std::array<Point3, 3> p = of_model(t);
        for (const auto& w : kTriangleSamples) {
          const Point3 sample = w[0] * p[0] + w[1] * p[1] + w[2] * p[2];
          if (tree.within(sample, 2 * tolerance_)) continue;
          points_.push_back({sample, Role::kFacet, static_cast<std::size_t>(facet.source), false});
        }
      }
    }
  }

  // Vertices that no facet and no segment names need not be nodes.
  void match_vertices() {
    std::vector<std::int32_t> order(mesh_.points.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
    const auto x = [&](std::int32_t i) { return point(i).x; };
    std::ranges::sort(order, {}, x);
    std::vector<char> named(model_.points.size(), 0);
    for (const ComplexEdge& e : model_.edges) {
      named[static_cast<std::size_t>(e.a)] = named[static_cast<std::size_t>(e.b)] = 1;
    }
    node_of_.assign(model_.points.size(), -1);
    for (std::size_t v = 0; v < named.size(); ++v) {
      if (named[v] == 0) continue;
      const Point3& p = model_.points[v];
      double best = tolerance_;
      auto at = std::ranges::lower_bound(order, p.x - tolerance_, {}, x);
      for (; at != order.end() && x(*at) <= p.x + tolerance_; ++at) {
        const double d = distance(point(*at), p);
        if (d > best) continue;
        best = d;
        node_of_[v] = *at;
      }
      if (node_of_[v] < 0) points_.push_back({p, Role::kVertex, v, false});
    }
  }

  void cover_segments() {
    collect_neighbours();
    for (std::size_t s = 0; s < model_.edges.size(); ++s) {
      const ComplexEdge& e = model_.edges[s];
      if (cover(e)) continue;
      const Point3 a = model_.points[static_cast<std::size_t>(e.a)];
      const Point3 b = model_.points[static_cast<std::size_t>(e.b)];
      for (const double t : kSegmentSamples) {
        points_.push_back({a + t * (b - a), Role::kSegment, s, false});
      }
    }
  }

  void collect_neighbours() {
    const std::vector<ElementEdge> edges = element_edges(mesh_);
    first_.assign(mesh_.points.size() + 1, 0);
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

  // Walks from one end to the other along mesh edges that lie on the segment.
  [[nodiscard]] bool cover(const ComplexEdge& segment) const {
    std::int32_t at = node_of_[static_cast<std::size_t>(segment.a)];
    const std::int32_t end = node_of_[static_cast<std::size_t>(segment.b)];
    if (at < 0 || end < 0) return false;
    const Point3 a = model_.points[static_cast<std::size_t>(segment.a)];
    const Point3 b = model_.points[static_cast<std::size_t>(segment.b)];
    const double whole = distance(a, b);
    if (!(whole > 0)) return at == end;
    const Point3 along = (1 / whole) * (b - a);
    while (at != end) {
      const double here = dot(point(at) - a, along);
      std::int32_t step = -1;
      double nearest = kFar;
      for (std::size_t i = first_[static_cast<std::size_t>(at)];
           i < first_[static_cast<std::size_t>(at) + 1]; ++i) {
        const Point3 d = point(around_[i]) - a;
        const double ahead = dot(d, along) - here;
        if (length(cross(along, d)) > tolerance_ || ahead <= 0 || ahead >= nearest) continue;
        nearest = ahead;
        step = around_[i];
      }
      if (step < 0 || here + nearest > whole + 2 * tolerance_) return false;
      at = step;
    }
    return true;
  }

  void check_boundary() {
    std::string wrong;
    for (std::size_t g = 0; g < full_.group_count() && wrong.empty(); ++g) {
      if (full_.sides(g) != 1 || constrained_[g] != 0) continue;
      wrong = "boundary " + facet_name(full_.first(g).nodes) + " of the mesh lies on no facet";
    }
    checks_.add("model.boundary", wrong.empty(), wrong);
  }

  void check_region_borders() {
    std::string wrong;
    for (std::size_t g = 0; g < full_.group_count() && wrong.empty(); ++g) {
      if (full_.sides(g) != 2 || constrained_[g] != 0) continue;
      const auto a = static_cast<std::size_t>(full_.first(g).element);
      const auto b = static_cast<std::size_t>(full_.second(g).element);
      if (mesh_.regions[a] == mesh_.regions[b]) continue;
      wrong = "the region changes across " + facet_name(full_.first(g).nodes) +
              ", which is on no facet";
    }
    checks_.add("model.region_borders", wrong.empty(), wrong);
  }

  // Points of the model of which it matters whether an element is there.
  enum class Role : std::uint8_t { kVertex, kSegment, kFacet, kHole, kRegion };
  struct ModelPoint {
    Point3 point;
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
    for (std::size_t e = 0; e < mesh_.element_count() && !points_.empty(); ++e) find_points(e);
    for (const ModelPoint& p : points_) {
      if (p.role == Role::kRegion && !p.found) {
        wrong(Role::kRegion) = "no element at the seed of region " + std::to_string(p.index);
      }
    }
    static constexpr std::array<const char*, 5> kNames{
        "model.vertices", "model.segments", "model.facets", "model.holes", "model.regions"};
    for (std::size_t role = 0; role < kNames.size(); ++role) {
      checks_.add(kNames[role], wrong_[role].empty(), wrong_[role]);
    }
  }

  // Also on the element's faces.
  [[nodiscard]] static bool holds(const std::array<Point3, 4>& p, const Point3& q) {
    return orientation_3(q, p[1], p[2], p[3]) != Sign::kNegative &&
           orientation_3(p[0], q, p[2], p[3]) != Sign::kNegative &&
           orientation_3(p[0], p[1], q, p[3]) != Sign::kNegative &&
           orientation_3(p[0], p[1], p[2], q) != Sign::kNegative;
  }

  // Marks the points in element `e` and tells what is wrong with them there.
  void find_points(std::size_t e) {
    const std::array<Point3, 4> p = corners_of(mesh_, e);
    const double left = std::min({p[0].x, p[1].x, p[2].x, p[3].x});
    const double right = std::max({p[0].x, p[1].x, p[2].x, p[3].x});
    auto at =
        std::ranges::lower_bound(points_, left, {}, [](const ModelPoint& m) { return m.point.x; });
    for (; at != points_.end() && at->point.x <= right; ++at) {
      if (!holds(p, at->point)) continue;
      at->found = true;
      const std::string index = std::to_string(at->index);
      const std::string element = "element " + std::to_string(e);
      switch (at->role) {
        case Role::kVertex:
          wrong(at->role) = "vertex " + index + " of the model is no node but lies in " + element;
          break;
        case Role::kSegment: {
          const ComplexEdge& s = model_.edges[at->index];
          wrong(at->role) = "the segment from vertex " + std::to_string(s.a) + " to " +
                            std::to_string(s.b) + " is no chain of edges in " + element;
          break;
        }
        case Role::kFacet:
          wrong(at->role) = "facet " + index + " of the model is no union of faces in " + element;
          break;
        case Role::kHole: wrong(at->role) = element + " covers the seed of hole " + index; break;
        case Role::kRegion:
          if (mesh_.regions[e] == model_.regions[at->index].attribute) break;
          wrong(at->role) = element + " at the seed of region " + index + " has attribute " +
                            std::to_string(mesh_.regions[e]);
          break;
      }
    }
  }

  std::string& wrong(Role role) { return wrong_[static_cast<std::size_t>(role)]; }

  const FacetedMesh& full_;
  const MeshData& mesh_;
  const PlcComplex& model_;
  double tolerance_;
  Checks& checks_;
  std::vector<char> constrained_;
  std::vector<std::size_t> first_;    // of each node in around_
  std::vector<std::int32_t> around_;  // its neighbours
  std::vector<std::int32_t> node_of_;
  std::vector<ModelPoint> points_;
  std::array<std::string, 5> wrong_;  // by role
};

}  // namespace

std::vector<char> check_model(const FacetedMesh& full,
                              const Plc& model,
                              double tolerance,
                              Checks& checks) {
  ExecutionContext context;
  const Result<ValidPlc> valid = validate_plc(model, context);
  if (!valid) {
    checks.add("model.boundary", false, "the model is not valid: " + valid.error().message);
    return std::vector<char>(full.groups.size(), 0);
  }
  return PlcChecker(full, valid->complex, tolerance, checks).run();
}

}  // namespace symcell::internal
