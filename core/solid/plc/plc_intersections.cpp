#include "core/solid/plc/plc_intersections.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/geometry/self_intersections.hpp"
#include "core/model/describe.hpp"

namespace symcell::solid {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using P = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::int32_t>;

struct Stop {};

// A point common to the triangle and the segment, to rounding, if they cross properly.
std::optional<Point3> crossing(Point3 a, Point3 b, Point3 c, Point3 p, Point3 q) {
  const Point3 n = cross(b - a, c - a);
  const double hp = dot(n, p - a);
  const double hq = dot(n, q - a);
  if ((hp > 0) == (hq > 0) || hp == hq) return std::nullopt;
  const Point3 x = p + (hp / (hp - hq)) * (q - p);
  constexpr double kSlack = -1e-9;  // of the squared area: a place to name, not a decision
  const double size = dot(n, n);
  const bool inside = dot(cross(b - a, x - a), n) >= kSlack * size &&
                      dot(cross(c - b, x - b), n) >= kSlack * size &&
                      dot(cross(a - c, x - c), n) >= kSlack * size;
  return inside ? std::optional(x) : std::nullopt;
}

class Checker {
 public:
  Checker(const PlcComplex& complex, ExecutionContext& context)
      : complex_(complex), context_(context) {
    surface_.points = complex.points;
    for (std::size_t f = 0; f < complex.facets.size(); ++f) {
      for (const auto& t : complex.facets[f].triangles.triangles) {
        surface_.triangles.push_back(t);
        surface_.source.push_back(static_cast<std::int32_t>(f));
      }
    }
    std::vector<std::uint8_t> in_facet(complex.edges.size(), 0);
    for (const ComplexFacet& facet : complex.facets) {
      for (std::size_t s = 0; s < facet.edges.size(); ++s) {
        if (facet.triangles.segment_sides[s] > 0) in_facet[at(facet.edges[s])] = 1;
      }
    }
    for (std::size_t e = 0; e < in_facet.size(); ++e) {
      if (in_facet[e] == 0) loose_.push_back(static_cast<std::int32_t>(e));
    }
  }

  Result<void> run() {
    auto pairs = self_intersections(surface_, 1, context_);
    if (!pairs) return error_of(pairs);
    if (!pairs->empty()) return facets_meet(pairs->front().first, pairs->front().second);
    SYMCELL_TRY(check_common_diagonals());
    if (loose_.empty()) return {};
    return check_loose_edges();
  }

 private:
  [[nodiscard]] Point3 corner(std::int32_t t, std::size_t i) const {
    return complex_.points[at(surface_.triangles[at(t)][i % 3])];
  }
  [[nodiscard]] Point3 end(std::int32_t e, int which) const {
    const ComplexEdge& edge = complex_.edges[at(e)];
    return complex_.points[at(which == 0 ? edge.a : edge.b)];
  }
  static P cgal_point(Point3 p) { return {p.x, p.y, p.z}; }

  [[nodiscard]] Result<void> facets_meet(std::int32_t s, std::int32_t t) const {
    const std::int32_t f = complex_.facets[at(surface_.source[at(s)])].source;
    const std::int32_t g = complex_.facets[at(surface_.source[at(t)])].source;
    std::optional<Point3> place;
    for (std::size_t i = 0; i < 3 && !place; ++i) {
      place = crossing(corner(s, 0), corner(s, 1), corner(s, 2), corner(t, i), corner(t, i + 1));
      if (place) break;
      place = crossing(corner(t, 0), corner(t, 1), corner(t, 2), corner(s, i), corner(s, i + 1));
    }
    // In one plane: the middle of the smaller triangle lies in or near the other.
    const bool coplanar = !place;
    if (!place) {
      const auto area = [&](std::int32_t k) {
        return squared_length(cross(corner(k, 1) - corner(k, 0), corner(k, 2) - corner(k, 0)));
      };
      const std::int32_t k = area(s) < area(t) ? s : t;
      place = (1.0 / 3) * (corner(k, 0) + corner(k, 1) + corner(k, 2));
    }
    return fail(
        ErrorCode::kSelfIntersection,
        "facets " + std::to_string(std::min(f, g)) + " and " + std::to_string(std::max(f, g)) +
            (coplanar ? " overlap in one plane near " : " cross at ") + describe_point(*place) +
            "; facets may meet in common vertices and segments only",
        {std::min(f, g), std::max(f, g)}, "/facets/" + std::to_string(std::max(f, g)));
  }

  // Facets that cross from one common vertex to another may have triangles that meet along that
  // line and do not cross: it is a segment of neither.
  [[nodiscard]] Result<void> check_common_diagonals() const {
    struct Diagonal {
      std::int32_t a = 0, b = 0, facet = 0;
      auto operator<=>(const Diagonal&) const = default;
    };
    std::vector<Diagonal> diagonals;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const auto& v = surface_.triangles[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [a, b] = std::minmax(v[i], v[(i + 1) % 3]);
        if (!is_segment(a, b)) diagonals.push_back({a, b, surface_.source[t]});
      }
    }
    std::sort(diagonals.begin(), diagonals.end());
    diagonals.erase(std::unique(diagonals.begin(), diagonals.end()), diagonals.end());
    const auto same = std::adjacent_find(
        diagonals.begin(), diagonals.end(),
        [](const Diagonal& d, const Diagonal& e) { return d.a == e.a && d.b == e.b; });
    if (same == diagonals.end()) return {};
    const std::int32_t f = complex_.facets[at(same->facet)].source;
    const std::int32_t g = complex_.facets[at((same + 1)->facet)].source;
    return fail(ErrorCode::kSelfIntersection,
                "facets " + std::to_string(std::min(f, g)) + " and " +
                    std::to_string(std::max(f, g)) + " cross between " +
                    describe_point(complex_.points[at(same->a)]) + " and " +
                    describe_point(complex_.points[at(same->b)]) +
                    "; facets may meet in common vertices and segments only",
                {std::min(f, g), std::max(f, g)}, "/facets/" + std::to_string(std::max(f, g)));
  }

  // `a` < `b`.
  [[nodiscard]] bool is_segment(std::int32_t a, std::int32_t b) const {
    const auto edge = std::lower_bound(
        complex_.edges.begin(), complex_.edges.end(), std::pair(a, b),
        [](const ComplexEdge& e, const std::pair<std::int32_t, std::int32_t>& key) {
          return std::pair(e.a, e.b) < key;
        });
    return edge != complex_.edges.end() && edge->a == a && edge->b == b;
  }

  [[nodiscard]] std::string describe_edge(std::int32_t e) const {
    const ComplexEdge& edge = complex_.edges[at(e)];
    return "the segment from vertex " + std::to_string(edge.a) + " at " +
           describe_point(end(e, 0)) + " to vertex " + std::to_string(edge.b) + " at " +
           describe_point(end(e, 1));
  }

  // Beyond a common vertex.
  [[nodiscard]] bool edge_meets_triangle(std::int32_t e, std::int32_t t) const {
    const ComplexEdge& edge = complex_.edges[at(e)];
    const auto& v = surface_.triangles[at(t)];
    const Kernel::Segment_3 segment(cgal_point(end(e, 0)), cgal_point(end(e, 1)));
    const P a = cgal_point(corner(t, 0)), b = cgal_point(corner(t, 1)),
            c = cgal_point(corner(t, 2));
    for (std::size_t i = 0; i < 3; ++i) {
      if (v[i] != edge.a && v[i] != edge.b) continue;
      const P far = cgal_point(end(e, v[i] == edge.a ? 1 : 0));
      const Kernel::Segment_3 opposite(cgal_point(corner(t, i + 1)), cgal_point(corner(t, i + 2)));
      return CGAL::do_intersect(segment, opposite) || Kernel::Triangle_3(a, b, c).has_on(far);
    }
    return CGAL::do_intersect(segment, Kernel::Triangle_3(a, b, c));
  }

  [[nodiscard]] bool edges_meet(std::int32_t e, std::int32_t f) const {
    const ComplexEdge& p = complex_.edges[at(e)];
    const ComplexEdge& q = complex_.edges[at(f)];
    // Two that share an end and a direction would have been cut by conform.
    if (p.a == q.a || p.a == q.b || p.b == q.a || p.b == q.b) return false;
    return CGAL::do_intersect(Kernel::Segment_3(cgal_point(end(e, 0)), cgal_point(end(e, 1))),
                              Kernel::Segment_3(cgal_point(end(f, 0)), cgal_point(end(f, 1))));
  }

  Result<void> check_loose_edges() {
    std::vector<Box> edges;
    for (const std::int32_t e : loose_) {
      edges.emplace_back(cgal_point(end(e, 0)).bbox() + cgal_point(end(e, 1)).bbox(), e);
    }
    std::vector<Box> triangles;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const auto id = static_cast<std::int32_t>(t);
      triangles.emplace_back(cgal_point(corner(id, 0)).bbox() + cgal_point(corner(id, 1)).bbox() +
                                 cgal_point(corner(id, 2)).bbox(),
                             id);
    }
    Result<void> result;
    std::uint64_t looked_at = 0;
    const auto look = [&] {
      constexpr std::uint64_t kCheckEvery = 4096;  // pairs of boxes
      if (++looked_at % kCheckEvery != 0) return;
      result = context_.check();
      if (!result) throw Stop{};
    };
    try {
      CGAL::box_intersection_d(
          edges.begin(), edges.end(), triangles.begin(), triangles.end(),
          [&](const Box& e, const Box& t) {
            look();
            if (!edge_meets_triangle(e.info(), t.info())) return;
            const std::int32_t f = complex_.facets[at(surface_.source[at(t.info())])].source;
            const auto place = crossing(corner(t.info(), 0), corner(t.info(), 1),
                                        corner(t.info(), 2), end(e.info(), 0), end(e.info(), 1));
            result = fail(ErrorCode::kSelfIntersection,
                          describe_edge(e.info()) + " crosses facet " + std::to_string(f) +
                              (place ? " at " + describe_point(*place) : "") +
                              "; make the point a vertex of both",
                          {f}, "/facets/" + std::to_string(f));
            throw Stop{};
          });
      CGAL::box_self_intersection_d(edges.begin(), edges.end(), [&](const Box& e, const Box& f) {
        look();
        if (!edges_meet(e.info(), f.info())) return;
        result = fail(ErrorCode::kSelfIntersection, describe_edge(e.info()) + " crosses " +
                                                        describe_edge(f.info()) +
                                                        "; make the point a vertex of both");
        throw Stop{};
      });
    } catch (const Stop&) {
    }
    return result;
  }

  const PlcComplex& complex_;
  ExecutionContext& context_;
  IndexedSurface surface_;
  std::vector<std::int32_t> loose_;  // edges of no facet
};

}  // namespace

Result<void> check_intersections(const PlcComplex& complex, ExecutionContext& context) {
  return Checker(complex, context).run();
}

}  // namespace symcell::solid
