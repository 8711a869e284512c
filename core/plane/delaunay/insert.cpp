#include "core/plane/delaunay/insert.hpp"

#include <algorithm>

#include "core/plane/quotient/lifted_predicates.hpp"

namespace symcell::plane {

bool Editor::star_is_positive(Point2 x, const Cavity& cavity) const {
  for (const CavityEdge& side : cavity.edges) {
    Sign s;
    if ((side.a.exponent | side.b.exponent) == 0) {
      s = orientation(x, mesh_.point(side.a.orbit), mesh_.point(side.b.orbit));
    } else {
      const Point2 a = mesh_.lift(side.a.orbit, side.a.exponent),
                   b = mesh_.lift(side.b.orbit, side.b.exponent);
      s = certain_orientation(x, a, b,
                              std::max({internal::radius_bound(x), internal::radius_bound(a),
                                        internal::radius_bound(b)}));
    }
    if (s != Sign::kPositive) return false;
  }
  return true;
}

void Editor::fill_star(const OrbitVertex& apex,
                       const CavityTriangle* old_triangles,
                       std::size_t old_count,
                       const CavityEdge* edges,
                       std::size_t edge_count,
                       bool closed,
                       bool glued) {
  star_.clear();
  for (std::size_t i = 0; i < edge_count; ++i) {
    if (i < old_count) {
      mesh_.touch(old_triangles[i].t);
      star_.push_back(old_triangles[i].t);
    } else {
      star_.push_back(mesh_.add_triangle());
    }
  }
  for (std::size_t i = edge_count; i < old_count; ++i) mesh_.release_triangle(old_triangles[i].t);

  const bool journal = mesh_.in_transaction();
  for (std::size_t i = 0; i < edge_count; ++i) {
    const CavityEdge& side = edges[i];
    const TriangleId t = star_[i];
    Triangle& tri = mesh_.triangle(t);
    tri.v[0] = apex.orbit, tri.v[1] = side.a.orbit, tri.v[2] = side.b.orbit;
    tri.k[0] = static_cast<std::int16_t>(apex.exponent);
    tri.k[1] = static_cast<std::int16_t>(side.a.exponent);
    tri.k[2] = static_cast<std::int16_t>(side.b.exponent);
    tri.seg[0] = side.seg;
    tri.seg[1] = tri.seg[2] = kNoSubsegment;
    tri.face = side.face;
    tri.queued = 0;
    if (side.seg != kNoSubsegment) {
      mesh_.touch_subsegment(side.seg);
      mesh_.subsegment(side.seg).half_edge = 3 * t;
    }
    if (journal) {
      mesh_.touch_vertex(side.a.orbit);
      mesh_.touch_vertex(side.b.orbit);
      if (side.mate != kNoHalfEdge) mesh_.touch(triangle_of(side.mate));
    }
    mesh_.set_corner(side.a.orbit, 3 * t + 1);
    mesh_.set_corner(side.b.orbit, 3 * t + 2);
  }
  if (journal) mesh_.touch_vertex(apex.orbit);
  mesh_.set_corner(apex.orbit, 3 * star_[0]);

  for (std::size_t i = 0; i < edge_count; ++i) {
    const CavityEdge& side = edges[i];
    HalfEdge mate = side.mate;
    std::int32_t off = side.off;
    for (std::size_t g = 0; glued && g < edge_count; ++g) {
      if (edges[g].was != mate) continue;
      off = mesh_.subtract(off, edges[g].frame);
      mate = 3 * star_[g];
      break;
    }
    mesh_.link(3 * star_[i], mate, off);
    if (i + 1 < edge_count) {
      mesh_.link(3 * star_[i] + 1, 3 * star_[i + 1] + 2, 0);
    } else if (closed) {
      mesh_.link(3 * star_[i] + 1, 3 * star_[0] + 2, 0);
    }
  }
}

VertexId Editor::place(Point2 x, const Cavity& cavity, VertexKind kind, bool closed) {
  const VertexId v = mesh_.add_vertex(x, kind);
  fill_star({v, 0}, cavity.triangles.data(), cavity.triangles.size(), cavity.edges.data(),
            cavity.edges.size(), closed, !cavity.simple);
  for (const CavityTriangle& c : cavity.triangles) {
    if (c.e != 0) {
      ++counters_.crossings;
      break;
    }
  }
  created_.assign(star_.begin(), star_.end());
  return v;
}

void Editor::queue_star_sides() {
  for (const TriangleId t : star_) edges_.push_back(3 * t);
}

VertexId Editor::insert_in_cavity(TriangleId t, Point2 x, const Cavity& cavity, VertexKind kind) {
  if (cavity.simple && star_is_positive(x, cavity)) return place(x, cavity, kind, true);

  minimal_.simple = false;
  minimal_.triangles.assign(1, {t, 0});
  minimal_.edges.clear();
  for (std::uint32_t j = 0; j < 3; ++j) append_side(3 * t + j, 0, minimal_);
  if (!star_is_positive(x, minimal_)) return insert_near_edge(t, x, kind);
  const VertexId v = place(x, minimal_, kind, true);
  queue_star_sides();
  legalise();
  return v;
}

// For x within rounding of an edge of t: circumcentres of right triangles, for instance.
VertexId Editor::insert_near_edge(TriangleId t, Point2 x, VertexKind kind) {
  const Triangle& tri = mesh_.triangle(t);
  for (std::uint32_t j = 0; j < 3; ++j) {
    const Point2 a = mesh_.corner_point(tri, next3(j)), b = mesh_.corner_point(tri, prev3(j));
    const double radius =
        std::max({internal::radius_bound(x), internal::radius_bound(a), internal::radius_bound(b)});
    if (certain_orientation(x, a, b, radius) == Sign::kPositive) continue;
    if (tri.seg[j] != kNoSubsegment) return -1;
    return split_edge(3 * t + j, x, kind);
  }
  return -1;
}

VertexId Editor::insert_on_edge(HalfEdge h, Point2 x, const Cavity& cavity, VertexKind kind) {
  const TriangleId t = triangle_of(h);
  const std::uint32_t j = local_of(h);
  const SubsegmentId seg = mesh_.triangle(t).seg[j];
  const HalfEdge g = mesh_.triangle(t).nb[j];
  const bool two_sided = g != kNoHalfEdge;
  if (cavity.simple && star_is_positive(x, cavity)) {
    const VertexId v = place(x, cavity, kind, two_sided);
    if (seg != kNoSubsegment) split_subsegment(seg, v, cavity);
    return v;
  }
  return split_edge(h, x, kind);
}

// One or two triangles become two or four, then flips.
VertexId Editor::split_edge(HalfEdge h, Point2 x, VertexKind kind) {
  const TriangleId t = triangle_of(h);
  const std::uint32_t j = local_of(h);
  const SubsegmentId seg = mesh_.triangle(t).seg[j];
  const HalfEdge g = mesh_.triangle(t).nb[j];
  const bool two_sided = g != kNoHalfEdge;
  if (two_sided && triangle_of(g) == t) return split_self_adjacent(h, x, kind);

  minimal_.simple = false;
  minimal_.triangles.assign(1, {t, 0});
  minimal_.edges.clear();
  append_side(3 * t + next3(j), 0, minimal_);
  append_side(3 * t + prev3(j), 0, minimal_);
  minimal_.right_edges = 2;
  if (two_sided) {
    const std::int32_t e = mesh_.triangle(t).off[j];
    const TriangleId u = triangle_of(g);
    minimal_.triangles.push_back({u, e});
    append_side(3 * u + next3(local_of(g)), e, minimal_);
    append_side(3 * u + prev3(local_of(g)), e, minimal_);
  }
  if (!star_is_positive(x, minimal_)) return -1;
  const VertexId v = place(x, minimal_, kind, two_sided);
  if (seg != kNoSubsegment) split_subsegment(seg, v, minimal_);
  queue_star_sides();
  legalise();
  return v;
}

// The star of x was put in place of the cavity of an edge b -> ... -> a -> ... -> b: its sides at a
// and b become the two halves of the subsegment.
void Editor::split_subsegment(SubsegmentId s, VertexId x, const Cavity& cavity) {
  mesh_.touch_subsegment(s);
  const SubsegmentId half = mesh_.add_subsegment(mesh_.subsegment(s).parent);
  const auto mark = [&](HalfEdge h, SubsegmentId id) {
    mesh_.triangle(triangle_of(h)).seg[local_of(h)] = id;
    mesh_.subsegment(id).half_edge = h;
  };
  const std::size_t left = cavity.right_edges, all = cavity.edges.size();
  const HalfEdge at_b = 3 * star_.front() + 2, at_a = 3 * star_[left - 1] + 1;
  mark(at_b, s);
  mark(at_a, half);
  if (all > left) {
    mark(3 * star_.back() + 1, s);
    mark(3 * star_[left] + 2, half);
  } else {
    mesh_.link(at_b, kNoHalfEdge, 0);
    mesh_.link(at_a, kNoHalfEdge, 0);
  }
  mesh_.set_corner(x, 3 * star_.front());
}

// (o, s, Rs), whose sides o -> s and Rs -> o are one edge, becomes (o, x, Rx), (x, s, Rs) and
// (x, Rs, Rx) for x on o -> s.
VertexId Editor::split_self_adjacent(HalfEdge h, Point2 x, VertexKind kind) {
  const TriangleId t = triangle_of(h);
  const Triangle old = mesh_.triangle(t);
  std::uint32_t io = 0;
  while (old.v[io] != mesh_.centre()) ++io;
  const std::uint32_t is = next3(io), ir = prev3(io);
  // x in the frame of t and on the side o -> s; given on Rs -> o it is rotated over.
  const std::int32_t turn = mesh_.subtract(old.k[ir], old.k[is]);
  if (local_of(h) == is) x = mesh_.rotations().rotate(x, mesh_.subtract(0, turn));
  const SubsegmentId seg = old.seg[ir];
  const HalfEdge outer = old.nb[io];
  const std::int32_t outer_off = old.off[io];

  const VertexId v = mesh_.add_vertex(x, kind);
  mesh_.touch(t);
  mesh_.touch_vertex(mesh_.centre());
  mesh_.touch_vertex(old.v[is]);
  if (outer != kNoHalfEdge) mesh_.touch(triangle_of(outer));
  const TriangleId t1 = mesh_.add_triangle(), t2 = mesh_.add_triangle();
  const auto write = [&](TriangleId id, OrbitVertex a, OrbitVertex b, OrbitVertex c) {
    Triangle& tri = mesh_.triangle(id);
    const OrbitVertex corner[3] = {a, b, c};
    for (std::uint32_t i = 0; i < 3; ++i) {
      tri.v[i] = corner[i].orbit;
      tri.k[i] = static_cast<std::int16_t>(corner[i].exponent);
      tri.seg[i] = kNoSubsegment;
    }
    tri.face = old.face;
    tri.queued = 0;
  };
  const OrbitVertex o{old.v[io], 0}, s{old.v[is], old.k[is]}, r{old.v[ir], old.k[ir]};
  const OrbitVertex xs{v, 0}, xr{v, turn};
  write(t, o, xs, xr);
  write(t1, xs, s, r);
  write(t2, xs, r, xr);
  // The neighbour across o -> s is this triangle rotated back by one turn.
  const std::int32_t back = mesh_.subtract(0, turn);
  mesh_.link(3 * t + 2, 3 * t + 1, back);    // o -> x with Rx -> o
  mesh_.link(3 * t + 0, 3 * t2 + 1, 0);      // x -> Rx with Rx -> x
  mesh_.link(3 * t1 + 1, 3 * t2 + 2, 0);     // Rs -> x with x -> Rs
  mesh_.link(3 * t1 + 2, 3 * t2 + 0, back);  // x -> s with Rs -> Rx
  mesh_.link(3 * t1 + 0, outer, outer_off);  // s -> Rs
  mesh_.triangle(t1).seg[0] = old.seg[io];
  if (old.seg[io] != kNoSubsegment) {
    mesh_.touch_subsegment(old.seg[io]);
    mesh_.subsegment(old.seg[io]).half_edge = 3 * t1;
  }
  if (seg != kNoSubsegment) {
    mesh_.touch_subsegment(seg);
    const SubsegmentId half = mesh_.add_subsegment(mesh_.subsegment(seg).parent);
    mesh_.triangle(t).seg[1] = mesh_.triangle(t).seg[2] = seg;
    mesh_.subsegment(seg).half_edge = 3 * t + 2;
    mesh_.triangle(t1).seg[2] = mesh_.triangle(t2).seg[0] = half;
    mesh_.subsegment(half).half_edge = 3 * t1 + 2;
  }
  mesh_.set_corner(mesh_.centre(), 3 * t);
  mesh_.set_corner(v, 3 * t1);
  mesh_.set_corner(old.v[is], 3 * t1 + 1);
  ++counters_.crossings;
  star_ = {t, t1, t2};
  created_ = star_;
  for (const TriangleId id : star_) {
    for (std::uint32_t j = 0; j < 3; ++j) edges_.push_back(3 * id + j);
  }
  legalise();
  return v;
}

}  // namespace symcell::plane
