#include "core/plane/cut/cut_cell.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <utility>

#include "core/plane/quotient/star.hpp"

namespace symcell::plane {
namespace {

constexpr std::int32_t kUnset = -1;  // no component, exponent or way yet

class CellCutter {
 public:
  explicit CellCutter(const QuotientTriangulation& mesh)
      : mesh_(mesh),
        component_(mesh.triangle_slots(), kUnset),
        is_cut_(3 * mesh.triangle_slots(), 0) {
    cut_.exponent.assign(mesh.triangle_slots(), kUnset);
  }

  Result<CellCut> run() {
    find_components();
    if (mesh_.fold() > 1) {
      find_boundary();
      for (std::size_t c = 0; c < seeds_.size(); ++c) cut_component(static_cast<std::int32_t>(c));
    }
    for (const TriangleId seed : seeds_) {
      SYMCELL_TRY(unroll(seed));
    }
    if (mesh_.fold() > 1) gather_pieces();
    return std::move(cut_);
  }

 private:
  template <class Visit>
  void flood(TriangleId seed, const Visit& visit) {
    stack_.assign(1, seed);
    while (!stack_.empty()) {
      const TriangleId t = stack_.back();
      stack_.pop_back();
      for (std::uint32_t j = 0; j < 3; ++j) {
        const HalfEdge g = mesh_.triangle(t).nb[j];
        if (g != kNoHalfEdge && visit(3 * t + j, g)) stack_.push_back(triangle_of(g));
      }
    }
  }

  void find_components() {
    for (TriangleId seed = 0; seed < mesh_.triangle_slots(); ++seed) {
      if (!mesh_.alive(seed) || component_[seed] != kUnset) continue;
      const auto id = static_cast<std::int32_t>(seeds_.size());
      seeds_.push_back(seed);
      component_[seed] = id;
      flood(seed, [&](HalfEdge, HalfEdge g) {
        if (component_[triangle_of(g)] != kUnset) return false;
        component_[triangle_of(g)] = id;
        return true;
      });
    }
  }

  // Ends of the components' rings, and the wedges at boundary vertices. Boundary loops that wind
  // about the centre have the domain on their left: counter-clockwise ones are outer ends. One that
  // comes through the centre goes round it within the domain.
  void find_boundary() {
    inner_.resize(seeds_.size());
    outer_.resize(seeds_.size());
    std::vector<std::uint8_t> seen(3 * mesh_.triangle_slots(), 0);
    std::vector<VertexId> loop;
    const VertexId o = mesh_.centre();
    for (HalfEdge h = 0; h < seen.size(); ++h) {
      if (!mesh_.alive(triangle_of(h)) ||
          mesh_.triangle(triangle_of(h)).nb[local_of(h)] != kNoHalfEdge) {
        continue;
      }
      wedges_.emplace_back(mesh_.triangle(triangle_of(h)).v[next3(local_of(h))],
                           3 * triangle_of(h) + next3(local_of(h)));
      if (seen[h] != 0) continue;
      double winding = 0;
      loop.clear();
      for (HalfEdge at = h; seen[at] == 0; at = next_on_boundary(at)) {
        seen[at] = 1;
        const Triangle& t = mesh_.triangle(triangle_of(at));
        const std::uint32_t j = local_of(at);
        const Point2 a = mesh_.corner_point(t, next3(j)), b = mesh_.corner_point(t, prev3(j));
        if (t.v[next3(j)] != o && t.v[prev3(j)] != o) {
          winding += std::atan2(cross(a, b), dot(a, b));
        }
        if (t.v[prev3(j)] == o) winding -= angle_of_wedge(at);
        loop.push_back(t.v[next3(j)]);
      }
      // A loop winds by a multiple of 2 pi / n.
      const double turns = winding * static_cast<double>(mesh_.fold()) / (2 * std::numbers::pi);
      if (std::abs(turns) < 0.5) continue;
      const auto c = static_cast<std::size_t>(component_[triangle_of(h)]);
      std::vector<VertexId>& end = turns > 0 ? outer_[c] : inner_[c];
      end.insert(end.end(), loop.begin(), loop.end());
    }
    std::sort(wedges_.begin(), wedges_.end());
    if (o < 0) return;
    StarItem item = star_item(mesh_, mesh_.corner_of(o));
    if (!to_star_begin(mesh_, item)) {
      inner_[static_cast<std::size_t>(component_[item.t])].push_back(o);
    }
  }

  // Between this boundary half-edge and the next, at the vertex where it ends.
  [[nodiscard]] double angle_of_wedge(HalfEdge h) const {
    StarItem item{triangle_of(h), prev3(local_of(h)), 0};
    double sum = 0;
    do {
      const Triangle& t = mesh_.triangle(item.t);
      const Point2 x = mesh_.corner_point(t, item.i);
      const Point2 u = mesh_.corner_point(t, next3(item.i)) - x;
      const Point2 v = mesh_.corner_point(t, prev3(item.i)) - x;
      sum += std::atan2(cross(u, v), dot(u, v));
    } while (rotate_cw(mesh_, item));
    return sum;
  }

  // The boundary half-edge that starts where this one ends.
  [[nodiscard]] HalfEdge next_on_boundary(HalfEdge h) const {
    StarItem item{triangle_of(h), prev3(local_of(h)), 0};
    while (rotate_cw(mesh_, item)) {
    }
    return 3 * item.t + prev3(item.i);
  }

  [[nodiscard]] static std::size_t idx(VertexId v) { return static_cast<std::size_t>(v); }

  // Shortest path of edges from the inner to the outer end: fewest edges, then (among those met in
  // breadth-first order) shortest. Edges of the domain's boundary cost nothing, so this is a
  // breadth-first search on a double-ended queue. A path that came to the rim of a hole by an edge
  // inside leaves it at another vertex: else the cell, on both sides of the hole, would touch itself
  // there. So a vertex at the rim is reached in up to two ways, from where the path came to it.
  void cut_component(std::int32_t id) {
    const auto c = static_cast<std::size_t>(id);
    if (inner_[c].empty() || outer_[c].empty()) return;
    reach_.assign(2 * mesh_.vertex_slots(), {});
    is_goal_.assign(mesh_.vertex_slots(), 0);
    for (const VertexId v : outer_[c]) is_goal_[idx(v)] = 1;
    std::deque<std::size_t> queue;
    for (const VertexId v : inner_[c]) {
      reach_[2 * idx(v)].hops = 0;
      queue.push_back(2 * idx(v));
    }
    while (!queue.empty()) {
      const std::size_t way = queue.front();
      queue.pop_front();
      if (reach_[way].done) continue;
      reach_[way].done = true;
      if (is_goal_[way / 2] != 0) {
        trace(way);
        return;
      }
      visit_edges(way, id, queue);
    }
  }

  // Looks at the edges at a vertex in the component, wedge by wedge where it lies on the boundary.
  void visit_edges(std::size_t way, std::int32_t id, std::deque<std::size_t>& queue) {
    const auto v = static_cast<VertexId>(way / 2);
    const auto first = std::lower_bound(wedges_.begin(), wedges_.end(), std::pair(v, HalfEdge{0}));
    if (first == wedges_.end() || first->first != v) {
      visit_wedge(way, mesh_.corner_of(v), queue);
      return;
    }
    for (auto it = first; it != wedges_.end() && it->first == v; ++it) {
      if (component_[triangle_of(it->second)] == id) visit_wedge(way, it->second, queue);
    }
  }

  void visit_wedge(std::size_t way, HalfEdge corner, std::deque<std::size_t>& queue) {
    StarItem item = star_item(mesh_, corner);
    const StarItem begin = item;
    const bool only_boundary = reach_[way].entry == corner;
    for (;;) {
      const HalfEdge out = 3 * item.t + prev3(item.i);
      if (!only_boundary || is_open(out)) relax(way, out, star_corner(mesh_, item, 1), true, queue);
      const StarItem last = item;
      if (!rotate_ccw(mesh_, item)) {
        relax(way, 3 * last.t + next3(last.i), star_corner(mesh_, last, 2), false, queue);
        return;
      }
      if (item.t == begin.t && item.i == begin.i) return;
    }
  }

  [[nodiscard]] bool is_open(HalfEdge h) const {
    return mesh_.triangle(triangle_of(h)).nb[local_of(h)] == kNoHalfEdge;
  }

  // The first corner of the wedge at which the inner half-edge h starts or ends, kNoHalfEdge where
  // the vertex is inside the domain.
  [[nodiscard]] HalfEdge wedge_of(HalfEdge h, bool at_end) const {
    StarItem item{triangle_of(h), at_end ? prev3(local_of(h)) : next3(local_of(h)), 0};
    if (!to_star_begin(mesh_, item)) return kNoHalfEdge;
    return 3 * item.t + item.i;
  }

  // `leaves`: h starts at the vertex, so its triangle is on the left of the way out. No symmetry
  // edge lies on the domain's boundary: such edges are free.
  void relax(
      std::size_t way, HalfEdge h, OrbitVertex to, bool leaves, std::deque<std::size_t>& queue) {
    const Reach here = reach_[way];
    const bool open = is_open(h);
    Reach next;
    next.hops = here.hops + (open ? 0 : 1);
    next.length = here.length + (open ? 0
                                      : distance(mesh_.point(static_cast<VertexId>(way / 2)),
                                                 mesh_.lift(to.orbit, to.exponent)));
    next.via = h;
    next.from = way;
    next.leaves = leaves;
    next.entry = open ? here.entry : wedge_of(h, leaves);
    const std::size_t first = 2 * idx(to.orbit);
    const auto less = [](const Reach& a, const Reach& b) {
      if (a.hops == kUnset || b.hops == kUnset) return a.hops != kUnset && b.hops == kUnset;
      return a.hops != b.hops ? a.hops < b.hops : a.length < b.length;
    };
    // In place of the way from the same entry, else of the worse one.
    std::size_t place = less(reach_[first], reach_[first + 1]) ? first + 1 : first;
    for (const std::size_t slot : {first, first + 1}) {
      if (reach_[slot].hops != kUnset && reach_[slot].entry == next.entry) place = slot;
    }
    Reach& there = reach_[place];
    if (there.done || !less(next, there)) return;
    const bool nearer = there.hops == kUnset || next.hops < there.hops || there.entry != next.entry;
    there = next;
    if (!nearer) return;  // queued already
    if (open) {
      queue.push_front(place);
    } else {
      queue.push_back(place);
    }
  }

  // Marks the path that ends there. On the left of the way out, counter-clockwise about the centre,
  // is the side of the lower bound.
  void trace(std::size_t way) {
    while (reach_[way].via != kNoHalfEdge) {
      const Reach& reach = reach_[way];
      const HalfEdge g = mesh_.triangle(triangle_of(reach.via)).nb[local_of(reach.via)];
      if (g != kNoHalfEdge) {
        is_cut_[reach.via] = is_cut_[g] = 1;
        cut_.lower.push_back(reach.leaves ? reach.via : g);
      }
      way = reach.from;
    }
  }

  // Gives every triangle of the piece the exponent that makes it fit its neighbours.
  Result<void> unroll(TriangleId seed) {
    cut_.exponent[seed] = 0;
    bool fits = true;
    flood(seed, [&](HalfEdge h, HalfEdge g) {
      if (is_cut_[h] != 0) return false;
      const Triangle& t = mesh_.triangle(triangle_of(h));
      const std::int32_t e = mesh_.add(cut_.exponent[triangle_of(h)], t.off[local_of(h)]);
      std::int32_t& there = cut_.exponent[triangle_of(g)];
      if (there == kUnset) {
        there = e;
        return true;
      }
      fits = fits && there == e;
      return false;
    });
    if (!fits) {
      return fail(ErrorCode::kInternal, "the cut leaves a piece that winds about the centre");
    }
    return {};
  }

  // Pieces may be turned one by one: bring them next to the first, the largest angle apart at last.
  void gather_pieces() {
    std::vector<Point2> sums(seeds_.size());
    std::vector<double> areas(seeds_.size(), 0);
    for (TriangleId t = 0; t < mesh_.triangle_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      const Triangle& tri = mesh_.triangle(t);
      const Point2 a = mesh_.corner_point(tri, 0), b = mesh_.corner_point(tri, 1),
                   c = mesh_.corner_point(tri, 2);
      const double area = cross(b - a, c - a);
      const auto id = static_cast<std::size_t>(component_[t]);
      sums[id] = sums[id] + mesh_.rotations().rotate(area * (a + b + c), cut_.exponent[t]);
      areas[id] += area;
    }
    const auto largest =
        static_cast<std::size_t>(std::max_element(areas.begin(), areas.end()) - areas.begin());
    std::vector<std::int32_t> turn(seeds_.size(), 0);
    const double sector = 2 * std::numbers::pi / static_cast<double>(mesh_.fold());
    for (std::size_t id = 0; id < seeds_.size(); ++id) {
      const Point2 r = id == largest ? Point2{1, 0} : sums[largest];
      const double angle = std::atan2(cross(r, sums[id]), dot(r, sums[id]));
      // The first piece is brought to the sector that begins at the x axis.
      const double steps = id == largest ? std::floor(angle / sector) : std::round(angle / sector);
      turn[id] = mesh_.rotations().reduce(-static_cast<std::int64_t>(steps));
    }
    for (std::size_t id = 0; id < seeds_.size(); ++id) {
      if (id != largest) turn[id] = mesh_.add(turn[id], turn[largest]);
    }
    for (TriangleId t = 0; t < mesh_.triangle_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      cut_.exponent[t] = mesh_.add(cut_.exponent[t], turn[static_cast<std::size_t>(component_[t])]);
    }
  }

  // How a vertex is reached: over half-edge `via` from another.
  struct Reach {
    std::int32_t hops = kUnset;
    double length = 0;
    HalfEdge via = kNoHalfEdge;
    std::size_t from = 0;          // index in reach_
    HalfEdge entry = kNoHalfEdge;  // the wedge at which the path came to this boundary
    bool leaves = false;
    bool done = false;
  };

  const QuotientTriangulation& mesh_;
  std::vector<std::int32_t> component_;
  std::vector<std::uint8_t> is_cut_;
  std::vector<std::vector<VertexId>> inner_, outer_;   // per component
  std::vector<std::pair<VertexId, HalfEdge>> wedges_;  // first corner of each wedge at the boundary
  std::vector<Reach> reach_;                           // two a vertex, of one component
  std::vector<std::uint8_t> is_goal_;                  // per vertex: on the outer end
  std::vector<TriangleId> seeds_;
  std::vector<TriangleId> stack_;
  CellCut cut_;
};

}  // namespace

Result<CellCut> cut_cell(const QuotientTriangulation& mesh) {
  return CellCutter(mesh).run();
}

}  // namespace symcell::plane
