// The operations of StarSurgery on Steiner points of segments: these stay on their segment, so
// their stars are looked at side by side and their places sought along the line.
#include <algorithm>

#include "core/plane/quotient/star.hpp"
#include "core/plane/refine/star_surgery.hpp"

namespace symcell::plane {
namespace {

// Whether a subsegment on the boundary of the region has the region on its other side too, at
// another exponent. (collect_region sees to the other edges.)
bool meets_itself(const std::vector<CavityEdge>& edges, const std::vector<CavityTriangle>& region) {
  for (const CavityEdge& e : edges) {
    if (e.seg == kNoSubsegment || e.mate == kNoHalfEdge) continue;
    for (const CavityTriangle& c : region) {
      if (c.t == triangle_of(e.mate)) return true;
    }
  }
  return false;
}

}  // namespace

// Appends the star of a corner, in its frame, to `region`; triangles listed already are left out.
bool StarSurgery::gather_star(OrbitVertex v, std::vector<CavityTriangle>& region) const {
  constexpr std::size_t kLargestRegion = 64;  // such stars are hopeless for any angle bound
  StarItem item = star_item(mesh_, mesh_.corner_of(v.orbit));
  item.e = mesh_.add(item.e, v.exponent);
  const StarItem start = item;
  const auto take = [&](const StarItem& s) {
    for (const CavityTriangle& c : region) {
      if (c.t == s.t) return c.e == s.e;
    }
    region.push_back({s.t, s.e});
    return region.size() <= kLargestRegion;
  };
  do {
    if (!take(item)) return false;
    if (!rotate_ccw(mesh_, item)) {
      item = start;
      while (rotate_cw(mesh_, item)) {
        if (!take(item)) return false;
      }
      return true;
    }
  } while (item.t != start.t || item.i != start.i);
  return item.e == start.e;  // not so only round the centre
}

bool StarSurgery::gather_union(std::initializer_list<OrbitVertex> removed) {
  union_.clear();
  for (const OrbitVertex& c : removed) {
    if (!gather_star(c, union_)) return false;
  }
  return true;
}

// The chain of subsegments through the removed segment vertices: a -> ... -> b.
bool StarSurgery::segment_ends(std::initializer_list<OrbitVertex> removed,
                               SegmentEnds& ends) const {
  struct Step {
    OrbitVertex at;
    SubsegmentId seg;
  };
  const auto steps_from = [&](OrbitVertex v, Step out[2]) {
    int count = 0;
    const auto add = [&](OrbitVertex at, SubsegmentId s) {
      if (s == kNoSubsegment) return;
      if (count < 2) out[count] = {at, s};
      ++count;
    };
    StarItem item = star_item(mesh_, mesh_.corner_of(v.orbit));
    to_star_begin(mesh_, item);
    item.e = mesh_.add(item.e, v.exponent);
    const StarItem begin = item;
    for (;;) {
      add(star_corner(mesh_, item, 1), mesh_.triangle(item.t).seg[prev3(item.i)]);
      const StarItem last = item;
      if (!rotate_ccw(mesh_, item)) {
        add(star_corner(mesh_, last, 2), mesh_.triangle(last.t).seg[next3(last.i)]);
        break;
      }
      if (item.t == begin.t && item.i == begin.i) break;
    }
    return count == 2 && mesh_.subsegment(out[0].seg).parent == mesh_.subsegment(out[1].seg).parent;
  };
  const auto on_segment = [&](OrbitVertex at) {
    for (const OrbitVertex& c : removed) {
      if (c == at) return mesh_.kind(c.orbit) == VertexKind::kSegment;
    }
    return false;
  };
  std::size_t expected = 0;
  for (const OrbitVertex& c : removed)
    expected += mesh_.kind(c.orbit) == VertexKind::kSegment ? 1 : 0;

  // One way to the end b, then the other way to the end a.
  Step steps[2];
  if (!steps_from(*removed.begin(), steps)) return false;
  ends.chain.clear();
  std::size_t met = 1;
  for (int way = 0; way < 2; ++way) {
    Step at = steps[way];
    if (way == 1) std::reverse(ends.chain.begin(), ends.chain.end());
    ends.chain.push_back(at.seg);
    while (on_segment(at.at)) {
      if (++met > expected) return false;
      Step on[2];
      if (!steps_from(at.at, on)) return false;
      at = on[0].seg == at.seg ? on[1] : on[0];
      ends.chain.push_back(at.seg);
    }
    (way == 0 ? ends.a : ends.b) = at.at;
  }
  return met == expected;
}

// Left and right part of the region, as for a point on the edge a -> b: cavity_.edges run from b to
// a on the left and from a to b on the right; the chain's own sides are left out.
bool StarSurgery::collect_sides(std::initializer_list<OrbitVertex> removed,
                                const SegmentEnds& ends) {
  cavity_.triangles.clear();
  cavity_.edges.clear();
  std::int32_t inside = 0, free = 0;
  for (const OrbitVertex& c : removed) free += mesh_.kind(c.orbit) == VertexKind::kFree ? 1 : 0;
  const auto in_chain = [&](SubsegmentId s) {
    return s != kNoSubsegment &&
           std::find(ends.chain.begin(), ends.chain.end(), s) != ends.chain.end();
  };
  for (int way = 0; way < 2; ++way) {
    const OrbitVertex from = way == 0 ? ends.b : ends.a, to = way == 0 ? ends.a : ends.b;
    // The triangle on this side at the first removed vertex: its chain edge runs towards `from`.
    std::size_t seed = union_.size();
    for (std::size_t i = 0; i < union_.size() && seed == union_.size(); ++i) {
      const Triangle& tri = mesh_.triangle(union_[i].t);
      for (std::uint32_t j = 0; j < 3; ++j) {
        if (!in_chain(tri.seg[j])) continue;
        const std::uint32_t p = next3(j), q = prev3(j);
        const Point2 d = mesh_.lift(tri.v[q], mesh_.shift(tri.v[q], tri.k[q], union_[i].e)) -
                         mesh_.lift(tri.v[p], mesh_.shift(tri.v[p], tri.k[p], union_[i].e));
        const Point2 along =
            mesh_.lift(from.orbit, from.exponent) - mesh_.lift(to.orbit, to.exponent);
        if (dot(d, along) > 0) seed = i;
      }
    }
    if (seed == union_.size()) {
      if (way == 0) return false;
      break;  // the domain's boundary: one side only
    }
    std::swap(union_[0], union_[seed]);
    const std::int32_t interior = editor_.collect_region(union_, side_);
    if (interior < 0) return false;
    inside += interior;
    const std::size_t n = side_.edges.size();
    std::size_t start = n;
    for (std::size_t i = 0; i < n; ++i) {
      if (!in_chain(side_.edges[i].seg) && in_chain(side_.edges[(i + n - 1) % n].seg)) {
        if (start != n) return false;
        start = i;
      }
    }
    if (start == n || n <= ends.chain.size()) return false;
    const std::size_t kept = n - ends.chain.size();
    for (std::size_t i = 0; i < kept; ++i) {
      cavity_.edges.push_back(side_.edges[(start + i) % n]);
      if (in_chain(cavity_.edges.back().seg)) return false;
    }
    if (!(side_.edges[start].a == from) || !(cavity_.edges.back().b == to)) return false;
    cavity_.triangles.insert(cavity_.triangles.end(), side_.triangles.begin(),
                             side_.triangles.end());
    if (way == 0) {
      cavity_.right_edges = cavity_.edges.size();
      cavity_.right_triangles = cavity_.triangles.size();
    }
  }
  return inside == free && cavity_.triangles.size() == union_.size() &&
         !touches(cavity_.edges, removed) && !meets_itself(cavity_.edges, union_);
}

bool StarSurgery::merge_on_segment(std::initializer_list<OrbitVertex> removed) {
  for (const OrbitVertex& c : removed) {
    if (mesh_.kind(c.orbit) == VertexKind::kSegment && criteria_.is_shell_vertex(c.orbit))
      return false;
  }
  if (!gather_union(removed) || !segment_ends(removed, ends_)) return false;
  if (!collect_sides(removed, ends_)) return false;
  lift_edges(cavity_.edges, star_edges_);
  const Point2 a = mesh_.lift(ends_.a.orbit, ends_.a.exponent),
               b = mesh_.lift(ends_.b.orbit, ends_.b.exponent);
  const auto x = region_.find_on_line(star_edges_, a, b - a);
  if (!x) return false;
  const bool transaction = criteria_.must_look_at_stars() && !mesh_.in_transaction();
  if (transaction) mesh_.begin();
  const OrbitVertex kept = *removed.begin();
  mesh_.touch_vertex(kept.orbit);
  mesh_.move_vertex(kept.orbit, *x);
  const std::size_t left = cavity_.right_edges, all = cavity_.edges.size();
  editor_.fill_star(kept, cavity_.triangles.data(), cavity_.triangles.size(), cavity_.edges.data(),
                    all, all > left, false);
  for (const OrbitVertex& c : removed) {
    if (c.orbit != kept.orbit) mesh_.release_vertex(c.orbit);
  }
  const SubsegmentId to_a = ends_.chain.front(), to_b = ends_.chain.back();
  for (std::size_t i = 1; i + 1 < ends_.chain.size(); ++i) {
    mesh_.release_subsegment(ends_.chain[i]);
  }
  const auto mark = [&](HalfEdge h, SubsegmentId s) {
    mesh_.triangle(triangle_of(h)).seg[local_of(h)] = s;
    mesh_.touch_subsegment(s);
    mesh_.subsegment(s).half_edge = h;
  };
  const std::vector<TriangleId>& star = editor_.star();
  const HalfEdge at_b = 3 * star.front() + 2, at_a = 3 * star[left - 1] + 1;
  mark(at_b, to_b);
  mark(at_a, to_a);
  if (all > left) {
    mark(3 * star.back() + 1, to_b);
    mark(3 * star[left] + 2, to_a);
  } else {
    mesh_.link(at_b, kNoHalfEdge, 0);
    mesh_.link(at_a, kNoHalfEdge, 0);
  }
  mesh_.set_corner(kept.orbit, 3 * star.front());
  finish_star();
  return keep_if_lengths_hold(transaction);
}

bool StarSurgery::unsplit(VertexId v) {
  if (mesh_.kind(v) != VertexKind::kSegment || criteria_.is_shell_vertex(v)) return false;
  if (!gather_union({{v, 0}}) || !segment_ends({{v, 0}}, ends_)) return false;
  if (!collect_sides({{v, 0}}, ends_)) return false;
  const SubsegmentId kept = ends_.chain.front();
  const bool two_sided = cavity_.edges.size() > cavity_.right_edges;
  std::optional<std::size_t> apex[2];
  for (int side = 0; side < (two_sided ? 2 : 1); ++side) {
    const auto begin = cavity_.edges.begin();
    const auto split = begin + static_cast<std::ptrdiff_t>(cavity_.right_edges);
    polygon_[side].assign(side == 0 ? begin : split, side == 0 ? split : cavity_.edges.end());
    CavityEdge closing = polygon_[side].front();
    closing.a = polygon_[side].back().b;
    closing.b = polygon_[side].front().a;
    closing.mate = kNoHalfEdge;
    closing.off = 0;
    closing.seg = kept;
    polygon_[side].push_back(closing);
    apex[side] = fan_apex(polygon_[side]);
    if (!apex[side]) return false;
  }
  filled_.clear();
  fill_fan(polygon_[0], *apex[0], cavity_.triangles.data(), cavity_.right_triangles);
  if (two_sided) {
    const HalfEdge left = mesh_.subsegment(kept).half_edge;
    fill_fan(polygon_[1], *apex[1], cavity_.triangles.data() + cavity_.right_triangles,
             cavity_.triangles.size() - cavity_.right_triangles);
    mesh_.link(left, mesh_.subsegment(kept).half_edge, 0);
  }
  mesh_.release_subsegment(ends_.chain.back());
  mesh_.release_vertex(v);
  settle_filled();
  return true;
}

}  // namespace symcell::plane
