#include "core/plane/quotient/quotient_triangulation.hpp"

#include <algorithm>

namespace symcell::plane {
namespace {

template <class T>
void append_and_clear(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
  from.clear();
}

// Gives slots taken from a free list back, in the order that they were there.
template <class T>
void give_back(std::vector<T>& free_list, std::vector<T>& taken) {
  free_list.insert(free_list.end(), taken.rbegin(), taken.rend());
  taken.clear();
}

}  // namespace

VertexId QuotientTriangulation::add_vertex(Point2 p, VertexKind kind) {
  if (!free_vertices_.empty()) {
    const VertexId v = free_vertices_.back();
    free_vertices_.pop_back();
    if (journal_.active) {
      journal_.reused_vertices.push_back(v);
      save_vertex(v);
    }
    points_[static_cast<std::size_t>(v)] = p;
    kinds_[static_cast<std::size_t>(v)] = kind;
    corners_[static_cast<std::size_t>(v)] = kNoHalfEdge;
    return v;
  }
  points_.push_back(p);
  kinds_.push_back(kind);
  corners_.push_back(kNoHalfEdge);
  return static_cast<VertexId>(points_.size() - 1);
}

void QuotientTriangulation::release_vertex(VertexId v) {
  touch_vertex(v);
  kinds_[static_cast<std::size_t>(v)] = VertexKind::kDeleted;
  corners_[static_cast<std::size_t>(v)] = kNoHalfEdge;
  (journal_.active ? journal_.released_vertices : free_vertices_).push_back(v);
}

TriangleId QuotientTriangulation::add_triangle() {
  ++live_triangles_;
  if (!free_triangles_.empty()) {
    const TriangleId t = free_triangles_.back();
    free_triangles_.pop_back();
    if (journal_.active) {
      journal_.reused_triangles.push_back(t);
      save_triangle(t);
    }
    return t;
  }
  triangles_.emplace_back();
  triangles_.back().stamp = 0;
  triangles_.back().queued = 0;
  return static_cast<TriangleId>(triangles_.size() - 1);
}

void QuotientTriangulation::release_triangle(TriangleId t) {
  touch(t);
  triangles_[t].face = -1;
  triangles_[t].queued = 0;
  --live_triangles_;
  (journal_.active ? journal_.released_triangles : free_triangles_).push_back(t);
}

SubsegmentId QuotientTriangulation::add_subsegment(std::int32_t parent) {
  if (!free_subsegments_.empty()) {
    const SubsegmentId s = free_subsegments_.back();
    free_subsegments_.pop_back();
    if (journal_.active) {
      journal_.reused_subsegments.push_back(s);
      save_subsegment(s);
    }
    subsegments_[static_cast<std::size_t>(s)] = {kNoHalfEdge, parent, 0, true};
    return s;
  }
  subsegments_.push_back({kNoHalfEdge, parent, 0, true});
  return static_cast<SubsegmentId>(subsegments_.size() - 1);
}

void QuotientTriangulation::release_subsegment(SubsegmentId s) {
  touch_subsegment(s);
  subsegments_[static_cast<std::size_t>(s)].alive = false;
  (journal_.active ? journal_.released_subsegments : free_subsegments_).push_back(s);
}

HalfEdge QuotientTriangulation::flip(HalfEdge h) {
  const TriangleId t = triangle_of(h);
  const std::uint32_t j = local_of(h);
  const Triangle old_t = triangles_[t];
  const HalfEdge g = old_t.nb[j];
  const TriangleId u = triangle_of(g);
  const std::uint32_t i = local_of(g);
  SYMCELL_ASSERT(u != t && old_t.seg[j] == kNoSubsegment);
  const Triangle old_u = triangles_[u];
  const std::int32_t e = old_t.off[j];

  // t = (p, a, b) with p opposite the edge a -> b; u = (q, b, a) at exponent e.
  const std::uint32_t jn = next3(j), jp = prev3(j), in = next3(i), ip = prev3(i);
  const VertexId p = old_t.v[j], a = old_t.v[jn], b = old_t.v[jp], q = old_u.v[i];
  const auto kq = static_cast<std::int16_t>(shift(q, old_u.k[i], e));

  // The four outer sides: old half-edge, its new place, the exponent of its old frame.
  // New t = (p, a, q): edge 0 is a -> q, edge 1 is q -> p, edge 2 is p -> a.
  // New u = (q, b, p): edge 0 is b -> p, edge 1 is p -> q, edge 2 is q -> b.
  struct Side {
    HalfEdge was;
    HalfEdge now;
    std::int32_t frame;
    HalfEdge mate;
    std::int32_t off;
    SubsegmentId seg;
  };
  const Side sides[4] = {
      {3 * t + jp, 3 * t + 2, 0, old_t.nb[jp], old_t.off[jp], old_t.seg[jp]},  // p -> a
      {3 * t + jn, 3 * u + 0, 0, old_t.nb[jn], old_t.off[jn], old_t.seg[jn]},  // b -> p
      {3 * u + in, 3 * t + 0, e, old_u.nb[in], old_u.off[in], old_u.seg[in]},  // a -> q
      {3 * u + ip, 3 * u + 2, e, old_u.nb[ip], old_u.off[ip], old_u.seg[ip]},  // q -> b
  };
  touch(t);
  touch(u);
  if (journal_.active) {
    for (const Side& side : sides) {
      if (side.mate != kNoHalfEdge) save_triangle(triangle_of(side.mate));
      if (side.seg != kNoSubsegment) save_subsegment(side.seg);
    }
    save_vertex(p);
    save_vertex(a);
    save_vertex(b);
    save_vertex(q);
  }
  Triangle& nt = triangles_[t];
  Triangle& nu = triangles_[u];
  nt.v[0] = p, nt.v[1] = a, nt.v[2] = q;
  nt.k[0] = old_t.k[j], nt.k[1] = old_t.k[jn], nt.k[2] = kq;
  nu.v[0] = q, nu.v[1] = b, nu.v[2] = p;
  nu.k[0] = kq, nu.k[1] = old_t.k[jp], nu.k[2] = old_t.k[j];
  nt.seg[1] = nu.seg[1] = kNoSubsegment;
  nt.queued = nu.queued = 0;

  for (const Side& side : sides) {
    Triangle& owner = triangles_[triangle_of(side.now)];
    owner.seg[local_of(side.now)] = side.seg;
    if (side.seg != kNoSubsegment) {
      subsegments_[static_cast<std::size_t>(side.seg)].half_edge = side.now;
    }
    // The mate may be one of the four sides itself: two orbits of triangles can share two edges.
    HalfEdge mate = side.mate;
    std::int32_t off = mate == kNoHalfEdge ? 0 : add(side.frame, side.off);
    for (const Side& other : sides) {
      if (other.was == side.mate) {
        mate = other.now;
        off = subtract(off, other.frame);
        break;
      }
    }
    link(side.now, mate, off);
  }
  link(3 * t + 1, 3 * u + 1, 0);
  set_corner(p, 3 * t + 0);
  set_corner(a, 3 * t + 1);
  set_corner(q, 3 * t + 2);
  set_corner(b, 3 * u + 1);
  return 3 * t + 1;
}

std::uint32_t QuotientTriangulation::new_epoch() {
  if (++epoch_ == 0) {
    for (Triangle& t : triangles_) t.stamp = 0;
    epoch_ = 1;
  }
  return epoch_;
}

std::vector<TriangleId> QuotientTriangulation::breadth_first_order() {
  const std::uint32_t epoch = new_epoch();
  std::vector<TriangleId> order;
  order.reserve(live_triangles_);
  for (TriangleId seed = 0; seed < triangles_.size(); ++seed) {
    if (!alive(seed) || triangles_[seed].stamp == epoch) continue;
    triangles_[seed].stamp = epoch;
    order.push_back(seed);
    for (std::size_t head = order.size() - 1; head < order.size(); ++head) {
      for (const HalfEdge g : triangles_[order[head]].nb) {
        if (g == kNoHalfEdge || triangles_[triangle_of(g)].stamp == epoch) continue;
        triangles_[triangle_of(g)].stamp = epoch;
        order.push_back(triangle_of(g));
      }
    }
  }
  return order;
}

void QuotientTriangulation::compact() {
  SYMCELL_ASSERT(!journal_.active);
  const std::vector<TriangleId> order = breadth_first_order();
  std::vector<TriangleId> place(triangles_.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<TriangleId>(i);
  const auto moved = [&](HalfEdge h) {
    return h == kNoHalfEdge ? h : 3 * place[triangle_of(h)] + local_of(h);
  };
  std::vector<Triangle> sorted;
  sorted.reserve(order.size() + order.size() / 2);
  for (const TriangleId t : order) {
    sorted.push_back(triangles_[t]);
    for (HalfEdge& h : sorted.back().nb) h = moved(h);
  }
  triangles_ = std::move(sorted);
  free_triangles_.clear();
  for (std::size_t v = 0; v < corners_.size(); ++v) corners_[v] = moved(corners_[v]);
  for (Subsegment& s : subsegments_) {
    if (s.alive) s.half_edge = moved(s.half_edge);
  }
}

void QuotientTriangulation::save_vertex(VertexId v) {
  const auto i = static_cast<std::size_t>(v);
  journal_.vertices.push_back({v, points_[i], corners_[i], kinds_[i]});
}

void QuotientTriangulation::begin() {
  SYMCELL_ASSERT(!journal_.active);
  journal_.active = true;
  journal_.triangle_slots = triangles_.size();
  journal_.vertex_slots = points_.size();
  journal_.subsegment_slots = subsegments_.size();
  journal_.live_triangles = live_triangles_;
}

void QuotientTriangulation::commit() {
  SYMCELL_ASSERT(journal_.active);
  journal_.active = false;
  journal_.triangles.clear();
  journal_.vertices.clear();
  journal_.subsegments.clear();
  journal_.reused_triangles.clear();
  journal_.reused_vertices.clear();
  journal_.reused_subsegments.clear();
  append_and_clear(free_triangles_, journal_.released_triangles);
  append_and_clear(free_vertices_, journal_.released_vertices);
  append_and_clear(free_subsegments_, journal_.released_subsegments);
}

void QuotientTriangulation::roll_back() {
  SYMCELL_ASSERT(journal_.active);
  journal_.active = false;
  for (auto it = journal_.triangles.rbegin(); it != journal_.triangles.rend(); ++it) {
    triangles_[it->id] = it->value;
  }
  for (auto it = journal_.vertices.rbegin(); it != journal_.vertices.rend(); ++it) {
    const auto i = static_cast<std::size_t>(it->id);
    points_[i] = it->point;
    corners_[i] = it->corner;
    kinds_[i] = it->kind;
  }
  for (auto it = journal_.subsegments.rbegin(); it != journal_.subsegments.rend(); ++it) {
    subsegments_[static_cast<std::size_t>(it->id)] = it->value;
  }
  journal_.triangles.clear();
  journal_.vertices.clear();
  journal_.subsegments.clear();
  triangles_.resize(journal_.triangle_slots);
  points_.resize(journal_.vertex_slots);
  corners_.resize(journal_.vertex_slots);
  kinds_.resize(journal_.vertex_slots);
  subsegments_.resize(journal_.subsegment_slots);
  give_back(free_triangles_, journal_.reused_triangles);
  give_back(free_vertices_, journal_.reused_vertices);
  give_back(free_subsegments_, journal_.reused_subsegments);
  journal_.released_triangles.clear();
  journal_.released_vertices.clear();
  journal_.released_subsegments.clear();
  live_triangles_ = journal_.live_triangles;
}

}  // namespace symcell::plane
