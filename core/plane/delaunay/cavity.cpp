// Dry runs of Editor: cavities and regions, found without changing the mesh.
#include <algorithm>

#include "core/plane/delaunay/insert.hpp"
#include "core/plane/quotient/lifted_predicates.hpp"

namespace symcell::plane {

void Editor::start(Cavity& cavity) {
  cavity.triangles.clear();
  cavity.edges.clear();
  cavity.right_triangles = cavity.right_edges = 0;
  cavity.simple = false;
  walk_.clear();
  self_met_ = false;
  epoch_ = mesh_.new_epoch();
}

void Editor::visit(TriangleId t, std::int32_t e, Cavity& cavity) {
  Triangle& tri = mesh_.triangle(t);
  tri.stamp = epoch_;
  tri.scratch = e;
  cavity.triangles.push_back({t, e});
}

bool Editor::in_conflict(TriangleId t, std::int32_t e, Point2 x) const {
  const Triangle& tri = mesh_.triangle(t);
  if ((tri.k[0] | tri.k[1] | tri.k[2] | e) == 0) {
    return in_circle(mesh_.point(tri.v[0]), mesh_.point(tri.v[1]), mesh_.point(tri.v[2]), x) ==
           Sign::kPositive;
  }
  Point2 p[3];
  double radius = internal::radius_bound(x);
  for (std::uint32_t i = 0; i < 3; ++i) {
    p[i] = mesh_.lift(tri.v[i], mesh_.shift(tri.v[i], tri.k[i], e));
    radius = std::max(radius, internal::radius_bound(p[i]));
  }
  return certain_in_circle(p[0], p[1], p[2], x, radius) == Sign::kPositive;
}

void Editor::append_side(HalfEdge h, std::int32_t e, Cavity& cavity) const {
  const Triangle& tri = mesh_.triangle(triangle_of(h));
  const std::uint32_t j = local_of(h), a = next3(j), b = prev3(j);
  CavityEdge side;
  side.a = {tri.v[a], mesh_.shift(tri.v[a], tri.k[a], e)};
  side.b = {tri.v[b], mesh_.shift(tri.v[b], tri.k[b], e)};
  side.mate = tri.nb[j];
  side.off = side.mate == kNoHalfEdge ? 0 : mesh_.add(e, tri.off[j]);
  side.seg = tri.seg[j];
  side.face = tri.face;
  side.was = h;
  side.frame = e;
  cavity.edges.push_back(side);
}

// Depth first from the edges on the stack, which leaves the sides in counter-clockwise order.
void Editor::grow(Point2 x, Cavity& cavity) {
  while (!walk_.empty()) {
    const Walk w = walk_.back();
    walk_.pop_back();
    const Triangle& tri = mesh_.triangle(w.t);
    const HalfEdge g = tri.nb[w.j];
    if (tri.seg[w.j] == kNoSubsegment && g != kNoHalfEdge) {
      const TriangleId u = triangle_of(g);
      const std::int32_t e = mesh_.add(w.e, tri.off[w.j]);
      const Triangle& other = mesh_.triangle(u);
      if (other.stamp == epoch_) {
        if (other.scratch == e) continue;  // an edge inside the cavity, seen from its second side
        // Another copy of a triangle of the cavity: keep it outside, remember that it was met.
        if (in_conflict(u, e, x)) self_met_ = true;
      } else if (in_conflict(u, e, x)) {
        visit(u, e, cavity);
        const std::uint32_t i = local_of(g);
        walk_.push_back({u, e, prev3(i)});
        walk_.push_back({u, e, next3(i)});
        continue;
      }
    }
    append_side(3 * w.t + w.j, w.e, cavity);
  }
}

// A side whose mate lies in the cavity, at whatever exponent, would be linked to a removed
// triangle.
void Editor::check_outside(Cavity& cavity) const {
  for (const CavityEdge& side : cavity.edges) {
    if (side.mate != kNoHalfEdge && mesh_.triangle(triangle_of(side.mate)).stamp == epoch_) {
      cavity.simple = false;
      return;
    }
  }
}

void Editor::compute_cavity(TriangleId t, Point2 x, Cavity& cavity) {
  start(cavity);
  visit(t, 0, cavity);
  for (std::uint32_t j = 3; j-- > 0;) walk_.push_back({t, 0, j});
  grow(x, cavity);
  // By Euler's formula a disc without interior vertex has two sides more than triangles.
  cavity.right_edges = cavity.edges.size();
  cavity.right_triangles = cavity.triangles.size();
  cavity.simple = !self_met_ && cavity.edges.size() == cavity.triangles.size() + 2;
  if (cavity.simple) check_outside(cavity);
}

void Editor::compute_edge_cavity(HalfEdge h, Point2 x, Cavity& cavity) {
  start(cavity);
  const TriangleId t = triangle_of(h);
  const std::uint32_t j = local_of(h);
  const HalfEdge g = mesh_.triangle(t).nb[j];
  if (g != kNoHalfEdge && triangle_of(g) == t) return;  // (o, a, Ra): never simple
  visit(t, 0, cavity);
  std::int32_t e = 0;
  if (g != kNoHalfEdge) {
    // Both sides are marked before either grows, so that neither takes the other's triangle.
    e = mesh_.triangle(t).off[j];
    Triangle& other = mesh_.triangle(triangle_of(g));
    other.stamp = epoch_;
    other.scratch = e;
  }
  walk_.push_back({t, 0, prev3(j)});
  walk_.push_back({t, 0, next3(j)});
  grow(x, cavity);
  cavity.right_edges = cavity.edges.size();
  cavity.right_triangles = cavity.triangles.size();
  bool simple = cavity.edges.size() == cavity.triangles.size() + 1;
  if (g != kNoHalfEdge) {
    const TriangleId u = triangle_of(g);
    const std::uint32_t i = local_of(g);
    cavity.triangles.push_back({u, e});
    walk_.push_back({u, e, prev3(i)});
    walk_.push_back({u, e, next3(i)});
    grow(x, cavity);
    simple = simple && cavity.edges.size() - cavity.right_edges ==
                           cavity.triangles.size() - cavity.right_triangles + 1;
  }
  cavity.simple = simple && !self_met_;
  if (cavity.simple) check_outside(cavity);
}

std::int32_t Editor::collect_region(const std::vector<CavityTriangle>& region, Cavity& cavity) {
  start(cavity);
  const std::uint32_t member = epoch_;
  for (const CavityTriangle& c : region) {
    Triangle& tri = mesh_.triangle(c.t);
    if (tri.stamp == member) return -1;  // listed twice: at two exponents
    tri.stamp = member;
    tri.scratch = c.e;
  }
  const std::uint32_t visited = epoch_ = mesh_.new_epoch();
  const auto enter = [&](TriangleId t, std::int32_t e) {
    mesh_.triangle(t).stamp = visited;
    cavity.triangles.push_back({t, e});
  };
  enter(region.front().t, region.front().e);
  for (std::uint32_t j = 3; j-- > 0;) walk_.push_back({region.front().t, region.front().e, j});
  while (!walk_.empty()) {
    const Walk w = walk_.back();
    walk_.pop_back();
    const Triangle& tri = mesh_.triangle(w.t);
    const HalfEdge g = tri.nb[w.j];
    if (g != kNoHalfEdge && tri.seg[w.j] == kNoSubsegment) {
      const TriangleId u = triangle_of(g);
      const std::int32_t e = mesh_.add(w.e, tri.off[w.j]);
      const Triangle& other = mesh_.triangle(u);
      if ((other.stamp == visited || other.stamp == member) && other.scratch == e) {
        if (other.stamp == visited) continue;
        enter(u, e);
        const std::uint32_t i = local_of(g);
        walk_.push_back({u, e, prev3(i)});
        walk_.push_back({u, e, next3(i)});
        continue;
      }
    }
    append_side(3 * w.t + w.j, w.e, cavity);
  }
  cavity.right_edges = cavity.edges.size();
  cavity.right_triangles = cavity.triangles.size();
  for (const CavityEdge& side : cavity.edges) {
    if (side.mate == kNoHalfEdge || side.seg != kNoSubsegment) continue;
    const std::uint32_t stamp = mesh_.triangle(triangle_of(side.mate)).stamp;
    if (stamp == visited || stamp == member) return -1;
  }
  // By Euler's formula a disc with I vertices inside has 2 - 2I sides more than triangles.
  const std::size_t doubled = cavity.triangles.size() + 2 - cavity.edges.size();
  if (cavity.edges.size() > cavity.triangles.size() + 2 || doubled % 2 != 0) return -1;
  cavity.simple = true;
  return static_cast<std::int32_t>(doubled / 2);
}

}  // namespace symcell::plane
