#include "core/solid/surface/editable_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

Result<EditableSurface> EditableSurface::create(QuotientSurface& surface) {
  const auto neighbours = find_neighbours(surface);
  if (!neighbours) return error_of(neighbours);
  EditableSurface editable(surface);
  editable.stars_.resize(surface.points.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const OrbitVertex& v : surface.triangles[t]) {
      auto& star = editable.stars_[v.orbit];
      const auto id = static_cast<std::int32_t>(t);
      if (star.empty() || star.back() != id) star.push_back(id);
    }
  }
  editable.mark_sides(*neighbours);
  return editable;
}

Result<EditableSurface> EditableSurface::create(QuotientSurface& surface,
                                                std::vector<std::array<std::uint8_t, 3>> marks) {
  auto editable = create(surface);
  if (editable) editable->marks_ = std::move(marks);
  return editable;
}

void EditableSurface::mark_sides(const std::vector<std::array<QuotientNeighbour, 3>>& neighbours) {
  marks_.assign(s_->triangles.size(), {0, 0, 0});
  for (std::size_t t = 0; t < marks_.size(); ++t) {
    for (std::size_t side = 0; side < 3; ++side) {
      const QuotientNeighbour& n = neighbours[t][side];
      // Normals of the input, as triangles at the cut may be so thin that theirs mean nothing.
      const Point3 other =
          rotations_.rotate(s_->normals[n.triangle], rotations_.reduce(n.exponent));
      if (dot(s_->normals[t], other) < kCreaseCosine) marks_[t][side] |= kCreaseSide;
      if (n.exponent != 0) marks_[t][side] |= kCutSide;
    }
  }
}

std::array<Point3, 3> EditableSurface::points(std::int32_t t) const {
  const QuotientTriangle& c = s_->triangles[t];
  return {point(c[0]), point(c[1]), point(c[2])};
}

Point3 EditableSurface::in_frame_of(std::int32_t v, std::int32_t t, Point3 direction) const {
  for (const OrbitVertex& c : s_->triangles[t]) {
    if (c.orbit == v) return rotations_.rotate(direction, rotations_.reduce(-c.exponent));
  }
  return direction;
}

std::int32_t EditableSurface::exponent_between(OrbitVertex from, OrbitVertex to) const {
  if (s_->on_axis[from.orbit] != 0 || s_->on_axis[to.orbit] != 0) return 0;
  return rotations_.reduce(to.exponent - from.exponent);
}

QuotientNeighbour EditableSurface::across(std::int32_t t, std::int32_t side) const {
  const OrbitVertex a = s_->triangles[t][side], b = s_->triangles[t][(side + 1) % 3];
  const std::int32_t between = exponent_between(a, b);
  for (const std::int32_t o : stars_[b.orbit]) {
    const QuotientTriangle& c = s_->triangles[o];
    for (std::int32_t i = 0; i < 3; ++i) {
      const OrbitVertex p = c[i], q = c[(i + 1) % 3];
      if (p.orbit != b.orbit || q.orbit != a.orbit) continue;
      if (o == t && i == side) continue;
      if (exponent_between(q, p) != between) continue;
      const OrbitVertex mine = s_->on_axis[a.orbit] != 0 ? b : a;
      const OrbitVertex theirs = s_->on_axis[a.orbit] != 0 ? p : q;
      return {o, i, mine.exponent - theirs.exponent};
    }
  }
  return {};
}

std::vector<EditableSurface::Neighbour> EditableSurface::ring(std::int32_t v) const {
  std::vector<Neighbour> ring;
  for (const std::int32_t t : stars_[v]) {
    const QuotientTriangle& c = s_->triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      if (c[i].orbit != v) continue;
      for (const std::size_t k : {(i + 1) % 3, (i + 2) % 3}) {
        ring.push_back({c[k].orbit, exponent_between(c[i], c[k])});
      }
    }
  }
  std::sort(ring.begin(), ring.end());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  return ring;
}

// Exactly two sides with this mark meet here, nearly in line.
bool EditableSurface::is_joint(std::int32_t v, std::uint8_t mark) const {
  std::array<Point3, 2> directions;
  std::size_t count = 0;
  for (const std::int32_t t : stars_[v]) {
    const QuotientTriangle& c = s_->triangles[t];
    for (std::int32_t i = 0; i < 3; ++i) {
      // Each edge once: from the triangle that runs away from v.
      if (c[i].orbit != v || (marks_[t][i] & mark) == 0) continue;
      if (count == 2) return false;
      // In the frame of v, so that directions across the cut compare.
      const std::int32_t back = rotations_.reduce(-c[i].exponent);
      const Point3 d = rotations_.rotate(point(c[(i + 1) % 3]) - point(c[i]), back);
      directions[count++] = (1 / std::max(length(d), 1e-300)) * d;
    }
  }
  return count == 2 && dot(directions[0], directions[1]) < -kCreaseCosine;
}

bool EditableSurface::may_leave(std::int32_t t, std::int32_t side, bool from_start) const {
  const std::int32_t v = s_->triangles[t][(side + (from_start ? 0 : 1)) % 3].orbit;
  if (s_->on_axis[v] != 0) return false;
  std::uint8_t marks = 0;
  for (const std::int32_t o : stars_[v]) {
    for (std::size_t i = 0; i < 3; ++i) {
      const QuotientTriangle& c = s_->triangles[o];
      if (c[i].orbit == v || c[(i + 1) % 3].orbit == v) marks |= marks_[o][i];
    }
  }
  if (marks == 0) return true;
  // Sides of all the kinds that meet here: along a crease that lies in the cut only.
  if ((marks_[t][side] & marks) != marks) return false;
  for (const std::uint8_t mark : {kCreaseSide, kCutSide}) {
    if ((marks & mark) != 0 && !is_joint(v, mark)) return false;
  }
  return true;
}

bool EditableSurface::along_one_cut(OrbitVertex a, OrbitVertex b) const {
  if (s_->on_cut[a.orbit] == 0 || s_->on_cut[b.orbit] == 0) return false;
  if (s_->on_axis[a.orbit] != 0 || s_->on_axis[b.orbit] != 0) return true;
  return a.exponent == b.exponent;
}

// Corner `at` of the triangle has become plan.to: its sides may lie in a cut only where they take
// the place of an edge of the cut.
bool EditableSurface::keeps_cut_clear(const PlannedTriangle& planned,
                                      std::size_t at,
                                      const CollapsePlan& plan) const {
  for (const std::size_t side : {at, (at + 2) % 3}) {
    const OrbitVertex other = planned.corners[side == at ? (at + 1) % 3 : side];
    if (!along_one_cut(planned.corners[at], other)) continue;
    bool of_cut = (marks_[planned.id][side] & kCutSide) != 0;
    for (const std::int32_t t : plan.removed) {
      const QuotientTriangle& c = s_->triangles[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = c[i].orbit, b = c[(i + 1) % 3].orbit;
        const bool same = (a == plan.to && b == other.orbit) || (b == plan.to && a == other.orbit);
        of_cut = of_cut || (same && (marks_[t][i] & kCutSide) != 0);
      }
    }
    if (!of_cut) return false;
  }
  return true;
}

std::optional<CollapsePlan> EditableSurface::plan_collapse(std::int32_t t,
                                                           std::int32_t side,
                                                           bool to_start) const {
  const QuotientTriangle& here = s_->triangles[t];
  const OrbitVertex start = here[side], end = here[(side + 1) % 3];
  const OrbitVertex from = to_start ? end : start, to = to_start ? start : end;
  if (from.orbit == to.orbit) return std::nullopt;
  const QuotientNeighbour other = across(t, side);
  if (other.triangle < 0) return std::nullopt;
  CollapsePlan plan;
  plan.from = from.orbit;
  plan.to = to.orbit;
  plan.removed = {t, other.triangle};
  const std::int32_t step = exponent_between(from, to);
  const bool to_axis = s_->on_axis[to.orbit] != 0;
  // Common neighbours are the two apexes, or the surface would pinch.
  const std::vector<Neighbour> mine = ring(from.orbit);
  std::vector<Neighbour> theirs = ring(to.orbit);
  for (Neighbour& n : theirs) {
    if (s_->on_axis[n.orbit] == 0) n.exponent = rotations_.reduce(n.exponent + step);
  }
  if (to_axis) {
    // Seen from an axis vertex all copies of a neighbour are one.
    for (Neighbour& n : theirs) n.exponent = 0;
  }
  std::sort(theirs.begin(), theirs.end());
  theirs.erase(std::unique(theirs.begin(), theirs.end()), theirs.end());
  std::size_t common = 0, copies = 0;
  std::vector<std::int32_t> others;
  for (Neighbour n : mine) {
    if (n.orbit == from.orbit) return std::nullopt;
    copies += n.orbit == to.orbit ? 1 : 0;
    if (to_axis) n.exponent = 0;
    const bool is_common = std::binary_search(theirs.begin(), theirs.end(), n);
    common += is_common ? 1 : 0;
    if (to_axis && !is_common) others.push_back(n.orbit);
  }
  if (common != 2 || copies != 1) return std::nullopt;
  // Two copies of a neighbour would be one, with the triangles of both.
  std::sort(others.begin(), others.end());
  if (std::adjacent_find(others.begin(), others.end()) != others.end()) return std::nullopt;
  // Of a tetrahedron one triangle and its back would be left.
  if (mine.size() == 3 && theirs.size() == 3) return std::nullopt;
  for (const std::int32_t o : stars_[from.orbit]) {
    if (o == t || o == other.triangle) continue;
    PlannedTriangle planned{o, s_->triangles[o], {}};
    std::size_t at = 0;
    while (planned.corners[at].orbit != from.orbit) ++at;
    const std::int32_t exponent =
        to_axis ? 0 : rotations_.reduce(planned.corners[at].exponent + step);
    if (exponent > 1) return std::nullopt;
    planned.corners[at] = {to.orbit, exponent};
    const auto& c = planned.corners;
    if (c[0].orbit == c[1].orbit || c[1].orbit == c[2].orbit || c[2].orbit == c[0].orbit) {
      return std::nullopt;
    }
    if (s_->on_axis[c[0].orbit] + s_->on_axis[c[1].orbit] + s_->on_axis[c[2].orbit] > 1) {
      return std::nullopt;
    }
    if (!keeps_cut_clear(planned, at, plan)) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) planned.points[i] = point(c[i]);
    plan.changed.push_back(planned);
  }
  return plan;
}

void EditableSurface::remove_from_star(std::int32_t v, std::int32_t t) {
  auto& star = stars_[v];
  star.erase(std::remove(star.begin(), star.end(), t), star.end());
}

void EditableSurface::collapse(const CollapsePlan& plan) {
  // The two other sides of a removed triangle become one edge: it has the marks of both.
  for (const std::int32_t t : plan.removed) {
    const QuotientTriangle& c = s_->triangles[t];
    std::array<QuotientNeighbour, 2> beside;
    std::uint8_t marks = 0;
    std::size_t count = 0;
    for (std::int32_t i = 0; i < 3; ++i) {
      const std::int32_t a = c[i].orbit, b = c[(i + 1) % 3].orbit;
      const bool between = (a == plan.from && b == plan.to) || (a == plan.to && b == plan.from);
      if (between) continue;
      marks |= marks_[t][i];
      beside[count++] = across(t, i);
    }
    for (const QuotientNeighbour& n : beside) {
      if (n.triangle >= 0) marks_[n.triangle][n.side] |= marks;
    }
  }
  for (const std::int32_t t : plan.removed) {
    for (const OrbitVertex& v : s_->triangles[t]) remove_from_star(v.orbit, t);
    s_->triangles[t][0].orbit = -1;
  }
  for (const PlannedTriangle& p : plan.changed) {
    s_->triangles[p.id] = p.corners;
    stars_[plan.to].push_back(p.id);
  }
  stars_[plan.from].clear();
}

std::optional<FlipPlan> EditableSurface::plan_flip(std::int32_t t, std::int32_t side) const {
  if (marks_[t][side] != 0) return std::nullopt;
  const QuotientNeighbour other = across(t, side);
  if (other.triangle < 0 || other.triangle == t || other.exponent != 0) return std::nullopt;
  const QuotientTriangle &c = s_->triangles[t], &d = s_->triangles[other.triangle];
  const std::int32_t next = (side + 1) % 3, apex = (side + 2) % 3;
  const std::int32_t other_next = (other.side + 1) % 3, other_apex = (other.side + 2) % 3;
  const OrbitVertex a = c[side], b = c[next], p = c[apex], q = d[other_apex];
  if (p.orbit == q.orbit) return std::nullopt;
  if (along_one_cut(p, q)) return std::nullopt;
  for (const std::int32_t o : stars_[p.orbit]) {
    for (const OrbitVertex& v : s_->triangles[o]) {
      if (v.orbit == q.orbit) return std::nullopt;
    }
  }
  FlipPlan plan;
  plan.changed[0] = {t, {a, q, p}, {point(a), point(q), point(p)}};
  plan.changed[1] = {other.triangle, {q, b, p}, {point(q), point(b), point(p)}};
  plan.marks[0] = {marks_[other.triangle][other_next], 0, marks_[t][apex]};
  plan.marks[1] = {marks_[other.triangle][other_apex], marks_[t][next], 0};
  return plan;
}

void EditableSurface::flip(const FlipPlan& plan) {
  for (std::size_t k = 0; k < 2; ++k) {
    const PlannedTriangle& p = plan.changed[k];
    for (const OrbitVertex& v : s_->triangles[p.id]) remove_from_star(v.orbit, p.id);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const PlannedTriangle& p = plan.changed[k];
    s_->triangles[p.id] = p.corners;
    marks_[p.id] = plan.marks[k];
    for (const OrbitVertex& v : p.corners) stars_[v.orbit].push_back(p.id);
  }
}

std::vector<PlannedTriangle> EditableSurface::split(std::int32_t t, std::int32_t side) {
  const QuotientNeighbour other = across(t, side);
  if (other.triangle < 0 || other.triangle == t) return {};
  const QuotientTriangle c = s_->triangles[t], d = s_->triangles[other.triangle];
  const OrbitVertex a = c[side], b = c[(side + 1) % 3], p = c[(side + 2) % 3];
  const OrbitVertex b2 = d[other.side], a2 = d[(other.side + 1) % 3], q = d[(other.side + 2) % 3];
  const bool of_cut = (marks_[t][side] & kCutSide) != 0;
  const bool from_higher = of_cut && std::max(a.exponent, b.exponent) == 1;
  const auto m = static_cast<std::int32_t>(s_->points.size());
  const Point3 middle = 0.5 * (point(a) + point(b));
  s_->points.push_back(from_higher ? 0.5 * (s_->points[a.orbit] + s_->points[b.orbit]) : middle);
  s_->on_axis.push_back(0);
  s_->on_cut.push_back(of_cut ? 1 : 0);
  stars_.emplace_back();
  const OrbitVertex here{m, from_higher ? 1 : 0};
  const OrbitVertex there{m, of_cut && std::max(a2.exponent, b2.exponent) == 1 ? 1 : 0};
  const auto first = static_cast<std::int32_t>(s_->triangles.size());
  const std::array<std::int32_t, 4> ids{t, first, other.triangle, first + 1};
  const std::array<QuotientTriangle, 4> corners{
      QuotientTriangle{a, here, p}, {here, b, p}, {b2, there, q}, {there, a2, q}};
  const std::array<std::uint8_t, 3> mt = marks_[t], mo = marks_[other.triangle];
  const std::uint8_t on_edge = mt[side];
  const std::array<std::array<std::uint8_t, 3>, 4> marks{
      std::array<std::uint8_t, 3>{on_edge, 0, mt[(side + 2) % 3]},
      {on_edge, mt[(side + 1) % 3], 0},
      {on_edge, 0, mo[(other.side + 2) % 3]},
      {on_edge, mo[(other.side + 1) % 3], 0}};
  for (const std::int32_t old : {t, other.triangle}) {
    for (const OrbitVertex& v : s_->triangles[old]) remove_from_star(v.orbit, old);
    s_->triangles.emplace_back();
    s_->normals.push_back(s_->normals[old]);
    s_->patch.push_back(s_->patch[old]);
    s_->frame.push_back(s_->frame[old]);
    marks_.emplace_back();
  }
  std::vector<PlannedTriangle> changed;
  for (std::size_t k = 0; k < 4; ++k) {
    s_->triangles[ids[k]] = corners[k];
    marks_[ids[k]] = marks[k];
    for (const OrbitVertex& v : corners[k]) {
      auto& star = stars_[v.orbit];
      if (star.empty() || star.back() != ids[k]) star.push_back(ids[k]);
    }
    changed.push_back({ids[k], corners[k], points(ids[k])});
  }
  return changed;
}

std::vector<PlannedTriangle> EditableSurface::plan_move(std::int32_t v, Point3 place) const {
  std::vector<PlannedTriangle> changed;
  for (const std::int32_t t : stars_[v]) {
    PlannedTriangle planned{t, s_->triangles[t], points(t)};
    for (std::size_t i = 0; i < 3; ++i) {
      if (planned.corners[i].orbit != v) continue;
      planned.points[i] = rotations_.rotate(place, planned.corners[i].exponent);
    }
    changed.push_back(planned);
  }
  return changed;
}

std::vector<std::int32_t> EditableSurface::compact() {
  std::vector<std::int32_t> old;
  std::size_t out = 0;
  for (std::size_t t = 0; t < s_->triangles.size(); ++t) {
    if (!alive(static_cast<std::int32_t>(t))) continue;
    s_->triangles[out] = s_->triangles[t];
    s_->normals[out] = s_->normals[t];
    s_->patch[out] = s_->patch[t];
    s_->frame[out] = s_->frame[t];
    marks_[out] = marks_[t];
    old.push_back(static_cast<std::int32_t>(t));
    ++out;
  }
  s_->triangles.resize(out);
  s_->normals.resize(out);
  s_->patch.resize(out);
  s_->frame.resize(out);
  marks_.resize(out);
  return old;
}

}  // namespace symcell::solid
