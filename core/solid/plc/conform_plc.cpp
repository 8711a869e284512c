#include "core/solid/plc/conform_plc.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/geometry/predicates.hpp"
#include "core/geometry/resolution.hpp"
#include "core/model/describe.hpp"

namespace symcell::solid {
namespace {

Point3 least(Point3 p, Point3 q) {
  return {std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)};
}
Point3 most(Point3 p, Point3 q) {
  return {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)};
}

class Conformer {
 public:
  Conformer(PlcComplex& complex, ExecutionContext& context)
      : complex_(complex),
        context_(context),
        radius_(resolution_of(complex.diameter, complex.magnitude)),
        tree_(complex.points) {}

  Result<void> run() {
    SYMCELL_TRY(find_splits());
    touched_.assign(complex_.facets.size(), 0);
    if (any_split_) apply_splits();
    for (std::size_t f = 0; f < complex_.facets.size(); ++f) {
      if (f % 64 == 0) {
        SYMCELL_TRY(context_.check());
      }
      find_points(f);
    }
    if (any_split_) collect_facet_edges(complex_);
    find_inner_segments();
    bool any = any_split_;
    for (std::size_t f = 0; f < complex_.facets.size(); ++f) {
      if (touched_[f] == 0) continue;
      any = true;
      SYMCELL_TRY(triangulate(complex_.facets[f]));
    }
    if (any) collect_facet_edges(complex_);
    return {};
  }

 private:
  // Per edge the points on it, from a to b.
  Result<void> find_splits() {
    splits_.resize(complex_.edges.size());
    for (std::size_t e = 0; e < complex_.edges.size(); ++e) {
      if (e % 256 == 0) {
        SYMCELL_TRY(context_.check());
      }
      const ComplexEdge& edge = complex_.edges[e];
      const Point3 a = complex_.points[at(edge.a)];
      const Point3 u = complex_.points[at(edge.b)] - a;
      const Point3 margin{radius_, radius_, radius_};
      std::vector<std::pair<double, std::int32_t>> on;
      tree_.within_box(least(a, a + u) - margin, most(a, a + u) + margin, [&](std::int32_t i) {
        if (i == edge.a || i == edge.b) return;
        const Point3 d = complex_.points[at(i)] - a;
        const double along = dot(d, u) / squared_length(u);
        if (along > 0 && along < 1 && length(d - along * u) <= radius_) on.emplace_back(along, i);
      });
      std::sort(on.begin(), on.end());
      for (const auto& [along, point] : on) splits_[e].push_back(point);
      if (!on.empty()) any_split_ = true;
    }
    return {};
  }

  [[nodiscard]] std::vector<IndexPair> pieces_of(std::size_t e) const {
    std::vector<IndexPair> pieces;
    std::int32_t from = complex_.edges[e].a;
    for (std::size_t i = 0; i <= splits_[e].size(); ++i) {
      const std::int32_t to = i < splits_[e].size() ? splits_[e][i] : complex_.edges[e].b;
      pieces.push_back({std::min(from, to), std::max(from, to)});
      from = to;
    }
    return pieces;
  }

  void apply_splits() {
    for (std::size_t f = 0; f < complex_.facets.size(); ++f) {
      ComplexFacet& facet = complex_.facets[f];
      std::vector<IndexPair> segments;
      for (const std::int32_t e : facet.edges) {
        if (!splits_[at(e)].empty()) touched_[f] = 1;
        const std::vector<IndexPair> pieces = pieces_of(at(e));
        segments.insert(segments.end(), pieces.begin(), pieces.end());
      }
      std::sort(segments.begin(), segments.end());
      segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
      facet.graph.segments = std::move(segments);
    }
    std::vector<ComplexEdge> edges;
    for (std::size_t e = 0; e < complex_.edges.size(); ++e) {
      for (const IndexPair& piece : pieces_of(e)) {
        edges.push_back({piece[0], piece[1], complex_.edges[e].marker});
      }
    }
    complex_.edges = std::move(edges);
  }

  [[nodiscard]] std::vector<std::int32_t> points_of(const ComplexFacet& facet) const {
    std::vector<std::int32_t> points = facet.graph.points;
    for (const IndexPair& s : facet.graph.segments) points.insert(points.end(), s.begin(), s.end());
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
  }

  // Points in the facet that it does not have. Its triangles are still those of the input.
  void find_points(std::size_t f) {
    ComplexFacet& facet = complex_.facets[f];
    const std::vector<std::int32_t> known = points_of(facet);
    const Point3 base = complex_.points[at(known.front())];
    Point3 low = base, high = base;
    double off = 0;  // of the facet's own points
    for (const std::int32_t i : known) {
      low = least(low, complex_.points[at(i)]);
      high = most(high, complex_.points[at(i)]);
      off = std::max(off, std::abs(dot(facet.graph.normal, complex_.points[at(i)] - base)));
    }
    const double reach = std::max(radius_, 2 * off);
    const Point3 margin{reach, reach, reach};
    std::vector<std::int32_t> found;
    tree_.within_box(low - margin, high + margin, [&](std::int32_t i) {
      if (std::binary_search(known.begin(), known.end(), i)) return;
      const Point3 p = complex_.points[at(i)];
      if (std::abs(dot(facet.graph.normal, p - base)) > reach) return;
      if (covers(complex_.points, facet, p)) found.push_back(i);
    });
    if (found.empty()) return;
    std::sort(found.begin(), found.end());
    facet.graph.points.insert(facet.graph.points.end(), found.begin(), found.end());
    touched_[f] = 1;
  }

  // Segments between two points of a facet that run in it.
  void find_inner_segments() {
    std::vector<std::vector<std::int32_t>> edges_at(complex_.points.size());
    for (std::size_t e = 0; e < complex_.edges.size(); ++e) {
      edges_at[at(complex_.edges[e].a)].push_back(static_cast<std::int32_t>(e));
    }
    for (std::size_t f = 0; f < complex_.facets.size(); ++f) {
      ComplexFacet& facet = complex_.facets[f];
      const std::vector<std::int32_t> points = points_of(facet);
      std::vector<IndexPair> added;
      for (const std::int32_t a : points) {
        for (const std::int32_t e : edges_at[at(a)]) {
          const IndexPair piece{a, complex_.edges[at(e)].b};
          if (!std::binary_search(points.begin(), points.end(), piece[1])) continue;
          const auto& own = facet.graph.segments;
          if (std::binary_search(own.begin(), own.end(), piece)) continue;
          const Point3 p = complex_.points[at(a)];
          const Point3 middle = p + 0.5 * (complex_.points[at(piece[1])] - p);
          if (covers(complex_.points, facet, middle)) added.push_back(piece);
        }
      }
      if (added.empty()) continue;
      touched_[f] = 1;
      auto& segments = facet.graph.segments;
      segments.insert(segments.end(), added.begin(), added.end());
      std::sort(segments.begin(), segments.end());
      segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
    }
  }

  Result<void> triangulate(ComplexFacet& facet) {
    std::erase_if(facet.graph.points, [&](std::int32_t i) {
      return std::any_of(facet.graph.segments.begin(), facet.graph.segments.end(),
                         [i](const IndexPair& s) { return s[0] == i || s[1] == i; });
    });
    auto triangles = triangulate_facet(complex_.points, facet.graph);
    if (!triangles) {
      const auto& at_fault = triangles.error().elements;
      std::string message = "facet " + std::to_string(facet.source) +
                            " is crossed by segments of other facets in its plane";
      if (at_fault.size() == 2) {
        message += ", by or at the one from vertex " + std::to_string(at_fault[0]) + " at " +
                   describe_point(complex_.points[static_cast<std::size_t>(at_fault[0])]) +
                   " to vertex " + std::to_string(at_fault[1]) + " at " +
                   describe_point(complex_.points[static_cast<std::size_t>(at_fault[1])]) +
                   owner_of(facet, at_fault);
      }
      return fail(ErrorCode::kSelfIntersection,
                  message + "; facets may meet in common vertices and segments only",
                  {facet.source}, "/facets/" + std::to_string(facet.source));
    }
    facet.triangles = std::move(*triangles);
    return {};
  }

  // Names another facet that has the segment.
  [[nodiscard]] std::string owner_of(const ComplexFacet& facet,
                                     const std::vector<std::int64_t>& ends) const {
    const IndexPair s{static_cast<std::int32_t>(std::min(ends[0], ends[1])),
                      static_cast<std::int32_t>(std::max(ends[0], ends[1]))};
    for (const ComplexFacet& other : complex_.facets) {
      if (other.source == facet.source) continue;
      if (std::binary_search(other.graph.segments.begin(), other.graph.segments.end(), s)) {
        return " of facet " + std::to_string(other.source);
      }
    }
    return "";
  }

  PlcComplex& complex_;
  ExecutionContext& context_;
  double radius_;
  PointTree tree_;
  std::vector<std::vector<std::int32_t>> splits_;
  bool any_split_ = false;
  std::vector<std::uint8_t> touched_;
};

}  // namespace

Result<void> conform(PlcComplex& complex, ExecutionContext& context) {
  return Conformer(complex, context).run();
}

}  // namespace symcell::solid
