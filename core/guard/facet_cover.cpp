#include "core/guard/facet_cover.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/rotation.hpp"
#include "core/geometry/tolerances.hpp"

namespace symcell {
namespace {

// Facets are flat to kPlanarityToleranceRel: other triangles of one have another area by a strip of
// that width along its outline at most. And bend by no more than that, of the diameter and of what
// they bend by as given; a vertex that is moved within its facet a few times may leave that strip a
// little.
constexpr double kBendRel = 10 * kPlanarityToleranceRel;
constexpr double kBendFactor = 10;

Failure broken(const std::string& what) {
  return fail(ErrorCode::kInternal, "mesh check 'facets': " + what);
}

class CoverMeter {
 public:
  explicit CoverMeter(const Constraints& c) : c_(c), rotations_(c.fold) {}

  Result<FacetCover> run() {
    add_lengths();
    add_areas();
    SYMCELL_TRY(add_edges());
    auto& all = cover_.incidences;
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::vector<OrbitTriangle> boundary;
    for (const Subfacet& f : c_.subfacets) {
      if (!f.two_sided) boundary.push_back(f.corners);
    }
    cover_.boundary = boundary_topology(c_.fold, c_.on_axis, boundary);
    return std::move(cover_);
  }

 private:
  [[nodiscard]] Point3 lift(OrbitVertex v) const {
    return rotations_.rotate(c_.points[at(v.orbit)], v.exponent);
  }

  // A subsegment on the cut of a sector may be listed as two copies.
  void add_lengths() {
    for (const Subsegment3& s : c_.subsegments) {
      segments_.emplace_back(orbit_edge(c_.fold, c_.on_axis, s.a, s.b), s.segment);
    }
    std::sort(segments_.begin(), segments_.end());
    segments_.erase(std::unique(segments_.begin(), segments_.end()), segments_.end());
    for (const auto& [edge, segment] : segments_) {
      if (cover_.segment_lengths.size() <= at(segment)) {
        cover_.segment_lengths.resize(at(segment) + 1, 0);
      }
      cover_.segment_lengths[at(segment)] +=
          distance(lift({edge.low, 0}), lift({edge.high, edge.exponent}));
    }
  }

  // -1: the edge is none of a segment.
  [[nodiscard]] std::int32_t segment_of(const OrbitEdge& edge) const {
    const auto found = std::lower_bound(segments_.begin(), segments_.end(), std::pair(edge, -1));
    return found != segments_.end() && found->first == edge ? found->second : -1;
  }

  FacetCover::Facet& facet(std::int32_t f) {
    if (cover_.facets.size() <= at(f)) cover_.facets.resize(at(f) + 1);
    return cover_.facets[at(f)];
  }

  void add_areas() {
    for (const Subfacet& s : c_.subfacets) {
      const Point3 a = lift(s.corners[0]);
      const double area = 0.5 * length(cross(lift(s.corners[1]) - a, lift(s.corners[2]) - a));
      (s.two_sided ? facet(s.facet).two_sided_area : facet(s.facet).one_sided_area) += area;
      triangles_.push_back(s.corners);
    }
  }

  // The sides of subfacets at one edge, those of one facet together.
  Result<void> add_edges() {
    std::vector<OrbitEdgeUse> uses = sorted_edge_uses(c_.fold, c_.on_axis, triangles_);
    const auto facet_of = [&](const OrbitEdgeUse& u) { return c_.subfacets[at(u.triangle)].facet; };
    for (std::size_t i = 0, next = 0; i < uses.size(); i = next) {
      for (next = i; next < uses.size() && uses[next].edge == uses[i].edge;) ++next;
      std::sort(uses.begin() + static_cast<std::ptrdiff_t>(i),
                uses.begin() + static_cast<std::ptrdiff_t>(next),
                [&](const OrbitEdgeUse& x, const OrbitEdgeUse& y) {
                  return std::tuple(facet_of(x), x.triangle, x.side) <
                         std::tuple(facet_of(y), y.triangle, y.side);
                });
      const std::int32_t segment = segment_of(uses[i].edge);
      for (std::size_t first = i, last = i; first < next; first = last) {
        while (last < next && facet_of(uses[last]) == facet_of(uses[first])) ++last;
        const std::span<const OrbitEdgeUse> own(&uses[first], last - first);
        if (segment >= 0) {
          add_incidence(segment, own);
        } else
          SYMCELL_TRY(check_inner(own));
      }
      if (segment < 0 && facet_of(uses[i]) != facet_of(uses[next - 1])) {
        return broken("facets " + std::to_string(facet_of(uses[i])) + " and " +
                      std::to_string(facet_of(uses[next - 1])) + " meet at an edge of no segment" +
                      place(uses[i]));
      }
    }
    return {};
  }

  void add_incidence(std::int32_t segment, std::span<const OrbitEdgeUse> own) {
    FacetCover::Incidence n{segment, c_.subfacets[at(own[0].triangle)].facet, 0, 0};
    for (const OrbitEdgeUse& u : own) {
      ++(c_.subfacets[at(u.triangle)].two_sided ? n.two_sided : n.one_sided);
    }
    cover_.incidences.push_back(n);
    if (own.size() == 1) facet(n.facet).outline += side_length(own[0]);
  }

  [[nodiscard]] OrbitVertex corner(const OrbitEdgeUse& u, std::int32_t i) const {
    return triangles_[at(u.triangle)][at((u.side + i) % 3)];
  }
  [[nodiscard]] double side_length(const OrbitEdgeUse& u) const {
    return distance(lift(corner(u, 0)), lift(corner(u, 1)));
  }
  [[nodiscard]] std::string place(const OrbitEdgeUse& u) const {
    const Point3 p = 0.5 * (lift(corner(u, 0)) + lift(corner(u, 1)));
    return " at (" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) +
           ") of the axis' frame";
  }

  // A facet goes on over an edge that is on no segment, on its other side.
  Result<void> check_inner(std::span<const OrbitEdgeUse> own) {
    const std::int32_t own_facet = c_.subfacets[at(own[0].triangle)].facet;
    const auto name = [&] { return "facet " + std::to_string(own_facet); };
    if (own.size() != 2) {
      return broken(name() + " has " + std::to_string(own.size()) +
                    " subfacets at an edge of no segment" + place(own[0]));
    }
    const Subfacet &s = c_.subfacets[at(own[0].triangle)], &t = c_.subfacets[at(own[1].triangle)];
    if (s.two_sided != t.two_sided) {
      return broken(name() +
                    " has the solid on one side and on both sides of an "
                    "edge of no segment" +
                    place(own[0]));
    }
    const OrbitVertex third = seen_from(own[0], own[1]);
    const Point3 a = lift(corner(own[0], 0)), b = lift(corner(own[0], 1)),
                 c = lift(corner(own[0], 2)), d = lift(third);
    const Point3 p = cross(b - a, c - a), q = cross(b - a, d - a);
    // Each corner moves the volume by its way and the area opposite.
    const double areas =
        length(p) + length(q) + length(cross(c - a, d - a)) + length(cross(c - b, d - b));
    double& bend = facet(own_facet).bend;
    bend = std::max(bend, std::abs(dot(p, d - a)) / areas);
    if (dot(p, q) < 0) return {};
    return broken(name() + " folds at an edge" + place(own[0]));
  }

  // The third corner of the other triangle, turned to where it adjoins the first.
  [[nodiscard]] OrbitVertex seen_from(const OrbitEdgeUse& first, const OrbitEdgeUse& other) const {
    const auto low = [&](const OrbitEdgeUse& u) { return corner(u, u.forward ? 0 : 1); };
    const auto high = [&](const OrbitEdgeUse& u) { return corner(u, u.forward ? 1 : 0); };
    const bool by_low = c_.on_axis[at(low(first).orbit)] == 0;
    const std::int32_t turn = by_low ? low(first).exponent - low(other).exponent
                                     : high(first).exponent - high(other).exponent;
    OrbitVertex third = corner(other, 2);
    if (c_.on_axis[at(third.orbit)] == 0) third.exponent = rotations_.reduce(third.exponent + turn);
    return third;
  }

  const Constraints& c_;
  RotationTable rotations_;
  FacetCover cover_;
  std::vector<OrbitTriangle> triangles_;                      // of the subfacets
  std::vector<std::pair<OrbitEdge, std::int32_t>> segments_;  // sorted
};

std::string amounts(double found, double wanted) {
  return std::to_string(found) + " in place of " + std::to_string(wanted);
}

Result<void> compare_boundaries(const BoundaryTopology& wanted, const BoundaryTopology& found) {
  if (found.shells != wanted.shells || found.euler != wanted.euler) {
    return broken("the boundary has " + std::to_string(found.shells) +
                  " shells and Euler characteristic " + std::to_string(found.euler) +
                  " in place of " + std::to_string(wanted.shells) + " and " +
                  std::to_string(wanted.euler));
  }
  if (found.open_edges > wanted.open_edges) {
    return broken("the boundary is open at " + std::to_string(found.open_edges) +
                  " orbits of edges");
  }
  if ((found.pinched_edges > 0) > (wanted.pinched_edges > 0)) {
    return broken("the boundary touches itself at an edge");
  }
  if (found.pinched_vertices != wanted.pinched_vertices) {
    return broken("the boundary touches itself at a vertex");
  }
  return {};
}

}  // namespace

Result<FacetCover> measure_facet_cover(const Constraints& constraints) {
  return CoverMeter(constraints).run();
}

Result<void> compare_facet_covers(const FacetCover& wanted,
                                  const FacetCover& found,
                                  double diameter) {
  for (std::size_t s = 0; s < std::max(wanted.segment_lengths.size(), found.segment_lengths.size());
       ++s) {
    const auto length = [&](const FacetCover& c) {
      return s < c.segment_lengths.size() ? c.segment_lengths[s] : 0.0;
    };
    if (std::abs(length(found) - length(wanted)) <= kSumRoundingRel * (length(wanted) + diameter)) {
      continue;
    }
    return broken("segment " + std::to_string(s) + " has a length of " +
                  amounts(length(found), length(wanted)));
  }
  for (std::size_t f = 0; f < std::max(wanted.facets.size(), found.facets.size()); ++f) {
    const auto facet = [&](const FacetCover& c) {
      return f < c.facets.size() ? c.facets[f] : FacetCover::Facet{};
    };
    const FacetCover::Facet w = facet(wanted), g = facet(found);
    const double area = w.one_sided_area + w.two_sided_area;
    const double allowed =
        kSumRoundingRel * area + kPlanarityToleranceRel * diameter * (w.outline + std::sqrt(area));
    if (std::abs(g.one_sided_area - w.one_sided_area) <= allowed &&
        std::abs(g.two_sided_area - w.two_sided_area) <= allowed) {
      continue;
    }
    return broken("facet " + std::to_string(f) + " has an area of " +
                  amounts(g.one_sided_area, w.one_sided_area) + " at the boundary and " +
                  amounts(g.two_sided_area, w.two_sided_area) + " inside");
  }
  for (std::size_t f = 0; f < found.facets.size(); ++f) {
    const double given = f < wanted.facets.size() ? wanted.facets[f].bend : 0;
    if (found.facets[f].bend <= kBendFactor * given + kBendRel * diameter) continue;
    return broken("facet " + std::to_string(f) + " is bent by " +
                  std::to_string(found.facets[f].bend));
  }
  for (const FacetCover::Incidence& n : found.incidences) {
    if (std::binary_search(wanted.incidences.begin(), wanted.incidences.end(), n)) continue;
    return broken("facet " + std::to_string(n.facet) + " has " +
                  std::to_string(n.one_sided + n.two_sided) + " subfacets at segment " +
                  std::to_string(n.segment));
  }
  return compare_boundaries(wanted.boundary, found.boundary);
}

}  // namespace symcell
