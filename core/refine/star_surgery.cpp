#include "core/refine/star_surgery.hpp"

#include <algorithm>

#include "core/delaunay/lifted_predicates.hpp"
#include "core/tds/star.hpp"

namespace symcell {

StarSurgery::StarSurgery(DelaunayEditor& editor, const Criteria& criteria)
    : editor_(editor),
      mesh_(editor.mesh()),
      criteria_(criteria),
      region_(criteria.goal_angle(), criteria.max_edge2()) {}

void StarSurgery::lift_edges(const std::vector<CavityEdge>& edges,
                             std::vector<StarEdge>& out) const {
  out.clear();
  for (const CavityEdge& e : edges) {
    out.push_back(
        {mesh_.lift(e.a.v, e.a.k), mesh_.lift(e.b.v, e.b.k), criteria_.max_area(e.face)});
  }
}

// Appends the star of a corner, in its frame, to `region`; triangles listed already are left out.
bool StarSurgery::gather_star(Corner v, std::vector<CavityTriangle>& region) const {
  constexpr std::size_t kLargestRegion = 64;  // such stars are hopeless for any angle bound
  StarItem item = star_item(mesh_, mesh_.corner_of(v.v));
  item.e = mesh_.add(item.e, v.k);
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

bool StarSurgery::gather_union(std::initializer_list<Corner> removed) {
  union_.clear();
  for (const Corner& c : removed) {
    if (!gather_star(c, union_)) return false;
  }
  return true;
}

namespace {

bool touches(const std::vector<CavityEdge>& edges, std::initializer_list<Corner> removed) {
  for (const CavityEdge& e : edges) {
    for (const Corner& c : removed) {
      if (e.a.v == c.v || e.b.v == c.v) return true;
    }
  }
  return false;
}

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

// Appends the star of an inner vertex to cavity_, counter-clockwise; of the two triangles at edge
// v-other only if `first`, and without sides.
bool StarSurgery::append_star(Corner v, const Corner* other, bool first) {
  StarItem item = star_item(mesh_, mesh_.corner_of(v.v));
  item.e = mesh_.add(item.e, v.k);
  if (other != nullptr) {
    // Begin at the triangle (v, other, .).
    const StarItem start = item;
    while (!(star_corner(mesh_, item, 1) == *other)) {
      if (!rotate_ccw(mesh_, item) || (item.t == start.t && item.i == start.i)) return false;
    }
  }
  const StarItem begin = item;
  do {
    const bool shared = other != nullptr && (star_corner(mesh_, item, 1) == *other ||
                                             star_corner(mesh_, item, 2) == *other);
    if (!shared || first) cavity_.triangles.push_back({item.t, item.e});
    if (!shared) editor_.append_side(3 * item.t + item.i, item.e, cavity_);
    if (cavity_.edges.size() > region_.most_edges() || !rotate_ccw(mesh_, item)) return false;
  } while (item.t != begin.t || item.i != begin.i);
  return item.e == begin.e;  // not so round the centre only
}

// Whether a triangle of the cavity, or the triangle behind one of its sides, is another copy of one
// of its triangles. In one frame throughout that cannot be.
bool StarSurgery::cavity_meets_itself() const {
  const std::int32_t e = cavity_.triangles.front().e;
  bool uniform = true;
  for (const CavityTriangle& c : cavity_.triangles) uniform = uniform && c.e == e;
  for (const CavityEdge& side : cavity_.edges) {
    uniform = uniform && (side.mate == kNoHalfEdge || side.off == e);
  }
  if (uniform) return false;
  for (std::size_t i = 0; i < cavity_.triangles.size(); ++i) {
    const TriangleId t = cavity_.triangles[i].t;
    for (std::size_t j = 0; j < i; ++j) {
      if (cavity_.triangles[j].t == t) return true;
    }
    for (const CavityEdge& side : cavity_.edges) {
      if (side.mate != kNoHalfEdge && triangle_of(side.mate) == t) return true;
    }
  }
  return false;
}

bool StarSurgery::gather_cavity(Corner v) {
  cavity_.triangles.clear();
  cavity_.edges.clear();
  return append_star(v, nullptr, true) && !cavity_meets_itself() && !touches(cavity_.edges, {v});
}

bool StarSurgery::gather_cavity(Corner v, Corner w) {
  cavity_.triangles.clear();
  cavity_.edges.clear();
  return append_star(v, &w, true) && append_star(w, &v, false) && !cavity_meets_itself() &&
         !touches(cavity_.edges, {v, w});
}

bool StarSurgery::relocate(VertexId v) {
  if (mesh_.kind(v) == VertexKind::kSegment) return merge_on_segment({{v, 0}});
  if (mesh_.kind(v) != VertexKind::kFree || !gather_cavity({v, 0})) return false;
  lift_edges(cavity_.edges, star_edges_);
  const auto x = region_.find(star_edges_);
  if (!x) return false;
  const bool transaction = criteria_.has_size_bound() && !mesh_.in_transaction();
  if (transaction) mesh_.begin();
  mesh_.touch_vertex(v);
  mesh_.move_vertex(v, *x);
  editor_.created().clear();
  for (const CavityEdge& side : cavity_.edges) {
    // The side and one spoke of each triangle are all edges of the star.
    const TriangleId t = triangle_of(side.was);
    editor_.created().push_back(t);
    editor_.queue_edge(side.was);
    editor_.queue_edge(3 * t + next3(local_of(side.was)));
  }
  editor_.legalise();
  return keep_if_sizes_hold(transaction);
}

bool StarSurgery::merge(Corner kept, Corner removed) {
  if (mesh_.kind(kept.v) == VertexKind::kSegment) return merge_on_segment({kept, removed});
  return mesh_.kind(kept.v) == VertexKind::kFree && mesh_.kind(removed.v) == VertexKind::kFree &&
         merge_free(kept, removed);
}

bool StarSurgery::keep_if_sizes_hold(bool transaction) {
  if (!transaction) return true;
  for (const TriangleId t : editor_.created()) {
    if (mesh_.alive(t) &&
        criteria_.assess(mesh_, mesh_.triangle(t)).verdict == Verdict::kSize) {
      mesh_.rollback();
      editor_.created().clear();
      return false;
    }
  }
  mesh_.commit();
  return true;
}

void StarSurgery::finish_star() {
  editor_.created().assign(editor_.star().begin(), editor_.star().end());
  editor_.queue_star();
  editor_.legalise();
}

bool StarSurgery::merge_free(Corner kept, Corner removed) {
  if (!gather_cavity(kept, removed)) return false;
  lift_edges(cavity_.edges, star_edges_);
  const auto x = region_.find(star_edges_);
  if (!x) return false;
  // Angles survive the flips that follow, areas and lengths need not.
  const bool transaction = criteria_.has_size_bound() && !mesh_.in_transaction();
  if (transaction) mesh_.begin();
  mesh_.touch_vertex(kept.v);
  mesh_.move_vertex(kept.v, *x);
  editor_.fill_star(kept, cavity_.triangles.data(), cavity_.triangles.size(),
                    cavity_.edges.data(), cavity_.edges.size(), true, false);
  mesh_.release_vertex(removed.v);
  finish_star();
  return keep_if_sizes_hold(transaction);
}

// The chain of subsegments through the removed segment vertices: a -> ... -> b.
bool StarSurgery::segment_ends(std::initializer_list<Corner> removed, SegmentEnds& ends) const {
  struct Step {
    Corner at;
    SubsegmentId seg;
  };
  const auto steps_from = [&](Corner v, Step out[2]) {
    int count = 0;
    const auto add = [&](Corner at, SubsegmentId s) {
      if (s == kNoSubsegment) return;
      if (count < 2) out[count] = {at, s};
      ++count;
    };
    StarItem item = star_item(mesh_, mesh_.corner_of(v.v));
    to_star_begin(mesh_, item);
    item.e = mesh_.add(item.e, v.k);
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
    return count == 2 &&
           mesh_.subsegment(out[0].seg).parent == mesh_.subsegment(out[1].seg).parent;
  };
  const auto on_segment = [&](Corner at) {
    for (const Corner& c : removed) {
      if (c == at) return mesh_.kind(c.v) == VertexKind::kSegment;
    }
    return false;
  };
  std::size_t expected = 0;
  for (const Corner& c : removed) expected += mesh_.kind(c.v) == VertexKind::kSegment ? 1 : 0;

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
bool StarSurgery::collect_sides(std::initializer_list<Corner> removed, const SegmentEnds& ends) {
  cavity_.triangles.clear();
  cavity_.edges.clear();
  std::int32_t inside = 0, free = 0;
  for (const Corner& c : removed) free += mesh_.kind(c.v) == VertexKind::kFree ? 1 : 0;
  const auto in_chain = [&](SubsegmentId s) {
    return s != kNoSubsegment &&
           std::find(ends.chain.begin(), ends.chain.end(), s) != ends.chain.end();
  };
  for (int way = 0; way < 2; ++way) {
    const Corner from = way == 0 ? ends.b : ends.a, to = way == 0 ? ends.a : ends.b;
    // The triangle on this side at the first removed vertex: its chain edge runs towards `from`.
    std::size_t seed = union_.size();
    for (std::size_t i = 0; i < union_.size() && seed == union_.size(); ++i) {
      const Triangle& tri = mesh_.triangle(union_[i].t);
      for (std::uint32_t j = 0; j < 3; ++j) {
        if (!in_chain(tri.seg[j])) continue;
        const std::uint32_t p = next3(j), q = prev3(j);
        const Point2 d = mesh_.lift(tri.v[q], mesh_.shift(tri.v[q], tri.k[q], union_[i].e)) -
                         mesh_.lift(tri.v[p], mesh_.shift(tri.v[p], tri.k[p], union_[i].e));
        const Point2 along = mesh_.lift(from.v, from.k) - mesh_.lift(to.v, to.k);
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

bool StarSurgery::merge_on_segment(std::initializer_list<Corner> removed) {
  for (const Corner& c : removed) {
    if (mesh_.kind(c.v) == VertexKind::kSegment && criteria_.is_shell_vertex(c.v)) return false;
  }
  if (!gather_union(removed) || !segment_ends(removed, ends_)) return false;
  if (!collect_sides(removed, ends_)) return false;
  lift_edges(cavity_.edges, star_edges_);
  const Point2 a = mesh_.lift(ends_.a.v, ends_.a.k), b = mesh_.lift(ends_.b.v, ends_.b.k);
  const auto x = region_.find_on_line(star_edges_, a, b - a);
  if (!x) return false;
  const bool transaction = criteria_.has_size_bound() && !mesh_.in_transaction();
  if (transaction) mesh_.begin();
  const Corner kept = *removed.begin();
  mesh_.touch_vertex(kept.v);
  mesh_.move_vertex(kept.v, *x);
  const std::size_t left = cavity_.right_edges, all = cavity_.edges.size();
  editor_.fill_star(kept, cavity_.triangles.data(), cavity_.triangles.size(),
                    cavity_.edges.data(), all, all > left, false);
  for (const Corner& c : removed) {
    if (c.v != kept.v) mesh_.release_vertex(c.v);
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
  mesh_.set_corner(kept.v, 3 * star.front());
  finish_star();
  return keep_if_sizes_hold(transaction);
}

// A vertex of the polygon from which all of it is seen, if there is one.
std::optional<std::size_t> StarSurgery::fan_apex(const std::vector<CavityEdge>& polygon) const {
  const std::size_t n = polygon.size();
  for (std::size_t apex = 0; apex < n; ++apex) {
    bool valid = true;
    for (std::size_t i = 1; i + 1 < n && valid; ++i) {
      const CavityEdge& e = polygon[(apex + i) % n];
      valid = orientation(mesh_, polygon[apex].a, e.a, e.b) == Sign::kPositive;
    }
    if (valid) return apex;
  }
  return std::nullopt;
}

// Triangulates a polygon from one of its vertices in place of `triangles`; appends to filled_.
void StarSurgery::fill_fan(const std::vector<CavityEdge>& polygon,
                           std::size_t apex,
                           const CavityTriangle* triangles,
                           std::size_t count) {
  const std::size_t n = polygon.size();
  fan_.clear();
  for (std::size_t i = 1; i + 1 < n; ++i) fan_.push_back(polygon[(apex + i) % n]);
  editor_.fill_star(polygon[apex].a, triangles, count, fan_.data(), fan_.size(), false, false);
  const auto close = [&](HalfEdge h, const CavityEdge& side) {
    if (side.mate != kNoHalfEdge) mesh_.touch(triangle_of(side.mate));
    mesh_.link(h, side.mate, side.off);
    mesh_.triangle(triangle_of(h)).seg[local_of(h)] = side.seg;
    if (side.seg != kNoSubsegment) {
      mesh_.touch_subsegment(side.seg);
      mesh_.subsegment(side.seg).half_edge = h;
    }
  };
  close(3 * editor_.star().front() + 2, polygon[apex]);
  close(3 * editor_.star().back() + 1, polygon[(apex + n - 1) % n]);
  filled_.insert(filled_.end(), editor_.star().begin(), editor_.star().end());
}

void StarSurgery::settle_filled() {
  editor_.created() = filled_;
  for (const TriangleId t : filled_) {
    for (std::uint32_t j = 0; j < 3; ++j) editor_.queue_edge(3 * t + j);
  }
  editor_.legalise();
}

bool StarSurgery::remove(VertexId v) {
  if (mesh_.kind(v) != VertexKind::kFree) return false;
  if (!gather_cavity({v, 0})) return false;
  const auto apex = fan_apex(cavity_.edges);
  if (!apex) return false;
  filled_.clear();
  fill_fan(cavity_.edges, *apex, cavity_.triangles.data(), cavity_.triangles.size());
  mesh_.release_vertex(v);
  settle_filled();
  return true;
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

}  // namespace symcell
