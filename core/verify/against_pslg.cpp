// A planar full mesh against its PSLG: every vertex and piece of segment that the meshed domain
// has is there, and the mesh ends where the domain does.
#include <algorithm>
#include <array>

#include "core/geometry/outline_distance.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/verify/against_model.hpp"

namespace symcell::internal {
namespace {

enum class On : char { kNothing = 0, kConstraint = 1, kBoundary = 2 };

class PlanarChecker {
 public:
  PlanarChecker(const FacetedMesh& full, const PlanarModel& model, double tolerance, Checks& checks)
      : full_(full),
        given_(model),
        pslg_(*model.pslg),
        model_(model.subdomains),
        tolerance_(tolerance),
        checks_(checks),
        on_(full.group_count(), On::kNothing) {}

  std::vector<char> run() {
    match_vertices();
    if (given_.by_shape) {
      compare_outlines();
    } else {
      cover_pieces();
      check_boundary();
    }
    std::vector<char> constrained(on_.size());
    std::ranges::transform(on_, constrained.begin(),
                           [](On on) { return static_cast<char>(on != On::kNothing); });
    check_seeds(constrained);
    return constrained;
  }

 private:
  [[nodiscard]] bool meshed(std::int32_t half_edge) const {
    return model_.left_of(half_edge).meshed;
  }

  void match_vertices() {
    const PointTree tree(full_.mesh.points);
    const std::vector<char> needed = vertices_of_domain(given_);
    node_of_.assign(needed.size(), -1);
    Flaws flaws;
    for (std::size_t v = 0; v < needed.size(); ++v) {
      if (needed[v] == 0 || (given_.by_shape && model_.map.vertex_face[v] < 0)) continue;
      const Point2 p = pslg_.vertices[v];
      const auto hit = tree.nearest({p.x, p.y, 0});
      if (hit.distance <= tolerance_) {
        node_of_[v] = hit.point;
        continue;
      }
      flaws.note([&] {
        return "vertex " + std::to_string(v) + " of the model is no node; the nearest is off by " +
               shown(hit.distance);
      });
    }
    flaws.report(checks_, "model.vertices");
  }

  void cover_pieces() {
    const NodeGraph graph(full_.mesh);
    const plane::PlanarMap& map = model_.map;
    Flaws flaws;
    for (std::size_t p = 0; p < map.pieces.size(); ++p) {
      const auto half_edge = static_cast<std::int32_t>(2 * p);
      const bool left = meshed(half_edge), right = meshed(half_edge + 1);
      if (!left && !right) continue;
      const plane::PlanarPiece& piece = map.pieces[p];
      if (cover(graph, piece, left == right ? On::kConstraint : On::kBoundary)) continue;
      flaws.note([&] {
        return "segment " + std::to_string(piece.segment) + " of the model, from vertex " +
               std::to_string(piece.a) + " to " + std::to_string(piece.b) +
               ", is no chain of edges";
      });
    }
    flaws.report(checks_, "model.segments");
  }

  bool cover(const NodeGraph& graph, const plane::PlanarPiece& piece, On on) {
    const std::int32_t from = node_of_[static_cast<std::size_t>(piece.a)];
    const std::int32_t to = node_of_[static_cast<std::size_t>(piece.b)];
    if (from < 0 || to < 0) return false;
    const auto chain = straight_chain(full_.mesh, graph, from, to, tolerance_);
    for (std::size_t i = 1; i < chain.size(); ++i) {
      std::array<std::int32_t, 3> edge{chain[i - 1], chain[i], -1};
      sort_facet(edge, 2);
      on_[full_.find(edge)] = on;
    }
    return !chain.empty();
  }

  void check_boundary() {
    Flaws outside, inside;
    for (std::size_t g = 0; g < full_.group_count(); ++g) {
      const auto name = [&] { return facet_name(full_.first(g).nodes); };
      if (full_.sides(g) == 1 && on_[g] != On::kBoundary) {
        outside.note([&] {
          return "boundary " + name() + " of the mesh lies on no segment that bounds the domain";
        });
      }
      if (full_.sides(g) != 1 && on_[g] == On::kBoundary) {
        inside.note(
            [&] { return name() + " has elements on both sides, but the domain ends there"; });
      }
    }
    outside.report(checks_, "model.boundary");
    inside.report(checks_, "model.boundary_complete");
  }

  // Both ways: the mesh's boundary against the domain's, then what lies inside. There an edge counts
  // as one of a segment if it runs along one.
  void compare_outlines() {
    std::vector<IndexedSegment> rim, inner;
    const plane::PlanarMap& map = model_.map;
    for (std::size_t p = 0; p < map.pieces.size(); ++p) {
      const auto half_edge = static_cast<std::int32_t>(2 * p);
      if (!given_.meshed_beside(p)) continue;
      const IndexedSegment piece{pslg_.vertices[static_cast<std::size_t>(map.pieces[p].a)],
                                 pslg_.vertices[static_cast<std::size_t>(map.pieces[p].b)]};
      (meshed(half_edge) == meshed(half_edge + 1) ? inner : rim).push_back(piece);
    }
    const SegmentIndex rim_index(rim), inner_index(inner);
    std::vector<IndexedSegment> boundary, along;
    Flaws outside;
    for (std::size_t g = 0; g < full_.group_count(); ++g) {
      const IndexedSegment edge{place(full_.first(g).nodes[0]), place(full_.first(g).nodes[1])};
      if (full_.sides(g) != 1) {
        if (inner.empty() || !follows(edge, inner_index)) continue;
        on_[g] = On::kConstraint;
        along.push_back(edge);
        continue;
      }
      boundary.push_back(edge);
      on_[g] = On::kBoundary;
      if (follows(edge, rim_index)) continue;
      outside.note([&] {
        return "boundary " + facet_name(full_.first(g).nodes) +
               " of the mesh is off what bounds the domain";
      });
    }
    Flaws uncovered;
    check_cover(rim, SegmentIndex(boundary), uncovered);
    check_cover(inner, SegmentIndex(along), uncovered);
    uncovered.report(checks_, "model.segments");
    outside.report(checks_, "model.boundary");
  }

  void check_cover(const std::vector<IndexedSegment>& pieces,
                   const SegmentIndex& edges,
                   Flaws& flaws) const {
    for (const IndexedSegment& piece : pieces) {
      if (follows(piece, edges)) continue;
      flaws.note([&] {
        return "the model's segment from (" + shown(piece.a.x) + ", " + shown(piece.a.y) +
               ") is farther than " + shown(tolerance_) + " from the mesh's edges";
      });
    }
  }

  [[nodiscard]] Point2 place(std::int32_t node) const {
    return planar(full_.mesh.points[static_cast<std::size_t>(node)]);
  }

  [[nodiscard]] bool follows(const IndexedSegment& piece, const SegmentIndex& index) const {
    constexpr double kResolution = 1e-3;  // of the tolerance, by which a distance may be under
    if (index.nearest(piece.a, tolerance_).segment < 0) return false;
    return outline_distance(index, piece.a, piece.b, kResolution * tolerance_) <= tolerance_;
  }

  void check_seeds(const std::vector<char>& constrained) {
    std::vector<Point3> holes;
    for (const Point2 p : pslg_.holes) holes.push_back({p.x, p.y, 0});
    std::vector<RegionSeed> regions;
    for (const PslgRegion& r : pslg_.regions) {
      regions.push_back({{r.point.x, r.point.y, 0}, r.attribute, r.max_area});
    }
    check_regions(full_, constrained, holes, regions, checks_);
  }

  const FacetedMesh& full_;
  const PlanarModel& given_;
  const Pslg& pslg_;
  const plane::Subdomains& model_;
  double tolerance_;
  Checks& checks_;
  std::vector<On> on_;                 // per edge of the mesh
  std::vector<std::int32_t> node_of_;  // per vertex of the model, -1: none
};

}  // namespace

std::vector<char> check_model(const FacetedMesh& full,
                              const PlanarModel& model,
                              double tolerance,
                              double /*diameter*/,
                              Checks& checks) {
  return PlanarChecker(full, model, tolerance, checks).run();
}

}  // namespace symcell::internal
