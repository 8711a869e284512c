#include "core/solid/sector/quotient_to_sector.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace symcell::solid {
namespace {

// Edges that turn by less, in radians, are one segment: where its middle vertex goes, the length changes by
// the square of that.
constexpr double kStraight = 1e-5;

class SectorBuilder {
 public:
  explicit SectorBuilder(const QuotientSurface& surface)
      : s_(surface), rotations_(surface.fold), uses_(sorted_edge_uses(surface)) {}

  Result<Sector> run() {
    auto neighbours = find_neighbours(s_);
    if (!neighbours) return error_of(neighbours);
    neighbours_ = std::move(*neighbours);
    sector_.fold = s_.fold;
    sector_.start_angle = s_.start_angle;
    sector_.nesting_decides = true;
    sector_.expected_volume = full_volume(s_);
    number_vertices();
    number_facets();
    find_edges();
    number_segments();
    return std::move(sector_);
  }

 private:
  struct Edge {
    QuotientEdgeUse use;
    QuotientEdgeUse mate;
  };

  void number_vertices() {
    std::vector<std::int32_t> orbit(s_.points.size(), -1);
    for (const QuotientTriangle& t : s_.triangles) {
      for (const OrbitVertex& v : t) orbit[v.orbit] = 0;
    }
    for (std::size_t v = 0; v < orbit.size(); ++v) {
      if (orbit[v] < 0) continue;
      orbit[v] = static_cast<std::int32_t>(sector_.orbit_points.size());
      sector_.orbit_points.push_back(s_.points[v]);
      sector_.on_axis.push_back(s_.on_axis[v]);
      sector_.vertices.push_back({orbit[v], 0});
    }
    orbit_ = std::move(orbit);
    higher_.assign(sector_.orbit_points.size(), -1);
    for (const QuotientTriangle& t : s_.triangles) {
      for (const OrbitVertex& v : t) {
        if (v.exponent != 0) higher_[orbit_[v.orbit]] = 0;
      }
    }
    for (std::size_t o = 0; o < higher_.size(); ++o) {
      if (higher_[o] < 0) continue;
      higher_[o] = static_cast<std::int32_t>(sector_.vertices.size());
      sector_.vertices.push_back({static_cast<std::int32_t>(o), 1});
    }
  }

  [[nodiscard]] std::int32_t vertex(OrbitVertex v) const {
    const std::int32_t o = orbit_[v.orbit];
    return v.exponent == 0 ? o : higher_[o];
  }

  // Whether two neighbours lie in one plane, also seen across the cut.
  [[nodiscard]] bool coplanar(std::int32_t t, const QuotientNeighbour& n) const {
    const std::int32_t p = s_.patch[t];
    if (p < 0 || s_.patch[n.triangle] != p) return false;
    if (s_.planes[p].normal.x == 0 && s_.planes[p].normal.y == 0) return true;
    return rotations_.reduce(s_.frame[t] - n.exponent) == s_.frame[n.triangle];
  }

  void number_facets() {
    facet_.assign(s_.triangles.size(), -1);
    std::int32_t count = 0;
    for (std::size_t seed = 0; seed < facet_.size(); ++seed) {
      if (facet_[seed] >= 0) continue;
      facet_[seed] = count;
      std::vector<std::int32_t> members{static_cast<std::int32_t>(seed)};
      for (std::size_t k = 0; k < members.size(); ++k) {
        for (const QuotientNeighbour& n : neighbours_[members[k]]) {
          if (facet_[n.triangle] >= 0 || !coplanar(members[k], n)) continue;
          facet_[n.triangle] = count;
          members.push_back(n.triangle);
        }
      }
      ++count;
    }
    sector_.facet_markers.assign(static_cast<std::size_t>(count), 0);
    for (std::size_t t = 0; t < s_.triangles.size(); ++t) {
      const QuotientTriangle& c = s_.triangles[t];
      sector_.faces.push_back({{vertex(c[0]), vertex(c[1]), vertex(c[2])}, facet_[t]});
    }
  }

  [[nodiscard]] static OrbitVertex end(const QuotientTriangle& t, std::int32_t side, int which) {
    return t[static_cast<std::size_t>((side + which) % 3)];
  }

  void find_edges() {
    for (std::size_t i = 0; i + 1 < uses_.size(); i += 2) {
      const QuotientEdgeUse &a = uses_[i], &b = uses_[i + 1];
      if (s_.fold > 1) add_to_cut(a, b);
      const QuotientNeighbour n{b.triangle, b.side, a.frame - b.frame};
      if (coplanar(a.triangle, n)) continue;
      edges_.push_back({a, b});
    }
  }

  // The side of an edge of the cut that lies on the lower half-plane.
  void add_to_cut(const QuotientEdgeUse& a, const QuotientEdgeUse& b) {
    if (s_.on_cut[a.low] == 0 || s_.on_cut[a.high] == 0 || a.exponent != 0) return;
    if (a.frame == b.frame) return;  // inside the wedge between two vertices of one cut
    const QuotientEdgeUse& lower = a.frame == 0 ? a : b;
    const QuotientTriangle& t = s_.triangles[lower.triangle];
    sector_.lower_cut.push_back({vertex(end(t, lower.side, 0)), vertex(end(t, lower.side, 1))});
  }

  // An edge seen from one of its ends: between which facets, in which frames.
  struct Side {
    std::int32_t facet, frame;
    friend bool operator==(const Side&, const Side&) = default;
    friend auto operator<=>(const Side&, const Side&) = default;
  };
  struct EdgeEnd {
    std::int32_t vertex;
    std::int32_t edge;
    Side first, second;
    Point3 direction;  // to the other end, in the frame of copy 0 of the vertex
  };

  [[nodiscard]] Point3 direction_from(const QuotientEdgeUse& use, bool first) const {
    const QuotientTriangle& t = s_.triangles[use.triangle];
    const OrbitVertex v = end(t, use.side, first ? 0 : 1), other = end(t, use.side, first ? 1 : 0);
    const Point3 d = corner_point(s_, rotations_, other) - corner_point(s_, rotations_, v);
    return rotations_.rotate(d, rotations_.reduce(-v.exponent));
  }

  [[nodiscard]] static bool in_one_line(const Point3& d, const Point3& e) {
    return dot(d, e) < 0 && length(cross(d, e)) <= kStraight * length(d) * length(e);
  }

  [[nodiscard]] Side side_of(const QuotientEdgeUse& use, std::int32_t exponent) const {
    const std::int32_t t = use.triangle;
    std::int32_t frame = 0;
    if (s_.patch[t] >= 0) {
      const Plane& plane = s_.planes[s_.patch[t]];
      const bool flat = plane.normal.x == 0 && plane.normal.y == 0;
      frame = flat ? 0 : rotations_.reduce(s_.frame[t] - exponent);
    } else {
      frame = rotations_.reduce(-exponent);
    }
    return {facet_[t], frame};
  }

  void number_segments() {
    std::vector<EdgeEnd> ends;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto& [a, b] = edges_[e];
      for (const bool high : {false, true}) {
        const std::int32_t v = high ? a.high : a.low;
        const auto exponent = [&](const QuotientEdgeUse& use) {
          const bool first = use.forward != high;
          return end(s_.triangles[use.triangle], use.side, first ? 0 : 1).exponent;
        };
        EdgeEnd entry{v, static_cast<std::int32_t>(e), side_of(a, exponent(a)),
                      side_of(b, exponent(b)), direction_from(a, a.forward != high)};
        if (entry.second < entry.first) std::swap(entry.first, entry.second);
        ends.push_back(entry);
      }
    }
    std::sort(ends.begin(), ends.end(), [](const EdgeEnd& x, const EdgeEnd& y) {
      return x.vertex != y.vertex ? x.vertex < y.vertex : x.edge < y.edge;
    });
    sector_.kinds.assign(sector_.orbit_points.size(), SectorVertexKind::kOnFacet);
    std::vector<std::int32_t> root(edges_.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&root](std::int32_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    for (std::size_t begin = 0; begin < ends.size();) {
      std::size_t stop = begin;
      while (stop < ends.size() && ends[stop].vertex == ends[begin].vertex) ++stop;
      const EdgeEnd& x = ends[begin];
      auto& kind = sector_.kinds[orbit_[x.vertex]];
      kind = SectorVertexKind::kFixed;
      // Two edges between the same two planes are on their common line, if the planes are not nearly
      // one: then edges between them may have any direction.
      if (stop - begin == 2 && s_.on_axis[x.vertex] == 0) {
        const EdgeEnd& y = ends[begin + 1];
        if (x.edge != y.edge && x.first == y.first && x.second == y.second &&
            x.first.facet != x.second.facet && in_one_line(x.direction, y.direction)) {
          kind = SectorVertexKind::kOnSegment;
          const std::int32_t i = find(x.edge), j = find(y.edge);
          if (i != j) root[std::max(i, j)] = std::min(i, j);
        }
      }
      begin = stop;
    }
    std::vector<std::int32_t> segment(edges_.size(), -1);
    std::int32_t count = 0;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      std::int32_t& id = segment[find(static_cast<std::int32_t>(e))];
      if (id < 0) id = count++;
      add_edge(edges_[e], id);
    }
    sector_.segment_markers.assign(static_cast<std::size_t>(count), 0);
    // On the axis a vertex of the surface is where it is pierced.
    for (std::size_t o = 0; o < sector_.kinds.size(); ++o) {
      if (sector_.on_axis[o] != 0) sector_.kinds[o] = SectorVertexKind::kFixed;
    }
  }

  // Once for each place in the sector: edges of the cut stand in both half-planes.
  void add_edge(const Edge& edge, std::int32_t segment) {
    const auto place = [&](const QuotientEdgeUse& use) {
      const QuotientTriangle& t = s_.triangles[use.triangle];
      return SectorEdge{vertex(end(t, use.side, 0)), vertex(end(t, use.side, 1)), segment};
    };
    const SectorEdge first = place(edge.use), second = place(edge.mate);
    sector_.edges.push_back(first);
    const bool same = std::minmax(first.a, first.b) == std::minmax(second.a, second.b);
    if (!same) sector_.edges.push_back(second);
  }

  const QuotientSurface& s_;
  RotationTable rotations_;
  std::vector<QuotientEdgeUse> uses_;
  std::vector<std::array<QuotientNeighbour, 3>> neighbours_;
  std::vector<std::int32_t> orbit_;   // of the surface's orbits: the sector's, -1: unused
  std::vector<std::int32_t> higher_;  // of the sector's orbits: the vertex on the higher cut
  std::vector<std::int32_t> facet_;   // per triangle
  std::vector<Edge> edges_;
  Sector sector_;
};

}  // namespace

Result<Sector> quotient_to_sector(const QuotientSurface& surface) {
  return SectorBuilder(surface).run();
}

}  // namespace symcell::solid
