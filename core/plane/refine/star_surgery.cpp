#include "core/plane/refine/star_surgery.hpp"

#include <algorithm>

#include "core/plane/quotient/lifted_predicates.hpp"
#include "core/plane/quotient/star.hpp"

namespace symcell::plane {

namespace {

// Places are sought a little within the bound of a vertex, for the rounding of the search.
constexpr double kReachShare = 1 - 1e-9;

}  // namespace

StarSurgery::StarSurgery(Editor& editor, const Criteria& criteria)
    : editor_(editor),
      mesh_(editor.mesh()),
      criteria_(criteria),
      region_(criteria.star_angle(), criteria.max_edge2()) {
}

bool StarSurgery::touches(const std::vector<CavityEdge>& edges,
                          std::initializer_list<OrbitVertex> removed) {
  for (const CavityEdge& e : edges) {
    for (const OrbitVertex& c : removed) {
      if (e.a.orbit == c.orbit || e.b.orbit == c.orbit) return true;
    }
  }
  return false;
}

void StarSurgery::lift_edges(const std::vector<CavityEdge>& edges,
                             std::vector<StarEdge>& out) const {
  out.clear();
  for (const CavityEdge& e : edges) {
    out.push_back({mesh_.lift(e.a.orbit, e.a.exponent), mesh_.lift(e.b.orbit, e.b.exponent),
                   criteria_.max_area(e.face),
                   kReachShare * criteria_.max_edge_at(mesh_, e.a.orbit)});
  }
}

// Appends the star of an inner vertex to cavity_, counter-clockwise; of the two triangles at edge
// v-other only if `first`, and without sides.
bool StarSurgery::append_star(OrbitVertex v, const OrbitVertex* other, bool first) {
  StarItem item = star_item(mesh_, mesh_.corner_of(v.orbit));
  item.e = mesh_.add(item.e, v.exponent);
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

bool StarSurgery::gather_cavity(OrbitVertex v) {
  cavity_.triangles.clear();
  cavity_.edges.clear();
  return append_star(v, nullptr, true) && !cavity_meets_itself() && !touches(cavity_.edges, {v});
}

bool StarSurgery::gather_cavity(OrbitVertex v, OrbitVertex w) {
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
  const bool transaction = criteria_.must_look_at_stars() && !mesh_.in_transaction();
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
  return keep_if_lengths_hold(transaction);
}

bool StarSurgery::merge(OrbitVertex kept, OrbitVertex removed) {
  if (mesh_.kind(kept.orbit) == VertexKind::kSegment) return merge_on_segment({kept, removed});
  return mesh_.kind(kept.orbit) == VertexKind::kFree &&
         mesh_.kind(removed.orbit) == VertexKind::kFree && merge_free(kept, removed);
}

bool StarSurgery::keep_if_lengths_hold(bool transaction) {
  if (!transaction) return true;
  for (const TriangleId t : editor_.created()) {
    if (!mesh_.alive(t)) continue;
    const Triangle& tri = mesh_.triangle(t);
    if (criteria_.assess(mesh_, tri).too_large || criteria_.has_short_edge(mesh_, tri)) {
      mesh_.roll_back();
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

bool StarSurgery::merge_free(OrbitVertex kept, OrbitVertex removed) {
  if (!gather_cavity(kept, removed)) return false;
  lift_edges(cavity_.edges, star_edges_);
  const auto x = region_.find(star_edges_);
  if (!x) return false;
  // Angles survive the flips that follow, areas and lengths need not.
  const bool transaction = criteria_.must_look_at_stars() && !mesh_.in_transaction();
  if (transaction) mesh_.begin();
  mesh_.touch_vertex(kept.orbit);
  mesh_.move_vertex(kept.orbit, *x);
  editor_.fill_star(kept, cavity_.triangles.data(), cavity_.triangles.size(), cavity_.edges.data(),
                    cavity_.edges.size(), true, false);
  mesh_.release_vertex(removed.orbit);
  finish_star();
  return keep_if_lengths_hold(transaction);
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

}  // namespace symcell::plane
