#include "core/solid/improve/surgery.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/assert.hpp"

namespace symcell::solid {
namespace {

// Rings of more tetrahedra are hardly ever worth removing, and cost grows with the cube.
constexpr std::size_t kMaxRing = 8;
// What a new vertex must better the worst shape by, to be worth its tetrahedra.
constexpr double kInsertionGain = 1.15;

}  // namespace

Surgery::Surgery(Editor& editor, const Criteria& criteria)
    : editor_(editor), mesh_(editor.mesh()), criteria_(criteria), insertion_(editor, criteria) {
  shapes_.resize(mesh_.tet_slots());
  for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
    if (!mesh_.alive(t)) continue;
    const auto x = editor_.points({t, 0});
    shapes_[t] = min_dihedral_sine(x[0], x[1], x[2], x[3]);
  }
}

double Surgery::excess_of(const TetMeasures& m, std::int32_t region, Exemption exempt) const {
  const double shortest2 = criteria_.min_edge() * criteria_.min_edge();
  if (m.shortest2 < shortest2) return kTooShort * shortest2 / m.shortest2;
  const double excess = criteria_.excess(m, region, exempt);
  if (!size_kept_ || excess <= 1) return excess;
  const double sized = criteria_.size_excess2(m, region);
  return sized > 1 ? kOversized * sized : excess;
}

void Surgery::include(
    Worth& w, double shape, const TetMeasures& m, std::int32_t region, Exemption exempt) const {
  w.shape = std::min(w.shape, shape);
  w.excess = std::max(w.excess, excess_of(m, region, exempt));
  if (exempt != Exemption::kNone) w.exempt = std::max(w.exempt, criteria_.ratio_excess(m));
}

bool Surgery::within(const LinkTet& t,
                     std::int32_t region,
                     Exemption exempt,
                     const Worth& limits) const {
  return t.sine > limits.shape && !is_flat(t.measures) &&
         excess_of(t.measures, region, exempt) <= limits.excess &&
         (exempt == Exemption::kNone || criteria_.ratio_excess(t.measures) <= limits.exempt);
}

Surgery::Worth Surgery::worth_of(std::span<const TetCopy> tets) const {
  Worth w;
  for (const TetCopy& c : tets) {
    const Tet& t = mesh_.tet(c.t);
    include(w, shapes_[c.t], editor_.measures(c.t), t.region, criteria_.exemption(mesh_, t));
  }
  return w;
}

Surgery::Worth Surgery::worth_of(std::span<const NewTet> tets) const {
  Worth w;
  for (const NewTet& t : tets) {
    const Point3 a = mesh_.lift(t.c[0]), b = mesh_.lift(t.c[1]), c = mesh_.lift(t.c[2]),
                 d = mesh_.lift(t.c[3]);
    const TetMeasures m = measure_tet(a, b, c, d);
    if (is_flat(m)) return {-1, kFar, kFar};
    include(w, min_dihedral_sine(a, b, c, d), m, t.region, exemption_of(t.c));
  }
  return w;
}

Exemption Surgery::exemption_of(std::span<const OrbitVertex> corners) const {
  Exemption found = Exemption::kNone;
  for (const OrbitVertex& x : corners) found = std::max(found, criteria_.exemption(mesh_, x.orbit));
  return found;
}

bool Surgery::all_within(std::span<const NewTet> tets,
                         const Moved& moved,
                         const Worth& limits) const {
  const auto place = [&](OrbitVertex x) { return x == moved.corner ? moved.place : mesh_.lift(x); };
  for (const NewTet& t : tets) {
    const auto& f = kFaceCorners[0];
    const LinkFace link(place(t.c[f[0]]), place(t.c[f[1]]), place(t.c[f[2]]));
    if (!within(LinkTet(place(t.c[0]), link, limits.shape), t.region, exemption_of(t.c), limits)) {
      return false;
    }
  }
  return true;
}

// Bounds come before shapes, those that must be kept before those that the input exempts from.
bool Surgery::better(const Worth& now, const Worth& before) {
  if (now.shape <= 0) return false;
  const bool shapelier = now.shape > before.shape * (1 + kGain);
  const auto less = [&](double excess, double old) {
    if (excess > old * (1 - kExcessGain)) return excess <= old && shapelier;
    return now.shape > std::min(before.shape, kPoorShape);
  };
  if (before.excess > 1) return less(now.excess, before.excess);
  if (now.excess > 1) return false;
  if (before.exempt > 1) return less(now.exempt, before.exempt);
  return now.exempt <= 1 && shapelier;
}

bool Surgery::apply(std::span<const TetCopy> removed,
                    std::span<const NewTet> added,
                    std::span<const EdgeKey> segment_edges) {
  if (!editor_.replace(removed, added, segment_edges)) return false;
  note_added();
  return true;
}

void Surgery::note_added() {
  ++edits_;
  if (shapes_.size() < mesh_.tet_slots()) shapes_.resize(mesh_.tet_slots());
  touched_.assign(mesh_.added_ids().begin(), mesh_.added_ids().end());
  for (const TetId t : touched_) {
    const auto x = editor_.points({t, 0});
    shapes_[t] = min_dihedral_sine(x[0], x[1], x[2], x[3]);
  }
}

void Surgery::roll_back() {
  ++edits_;
  for (const TetId t : editor_.roll_back()) {
    const auto x = editor_.points({t, 0});
    shapes_[t] = min_dihedral_sine(x[0], x[1], x[2], x[3]);
  }
}

void Surgery::refresh(TetId t) {
  editor_.remeasure(t);
  const auto x = editor_.points({t, 0});
  shapes_[t] = min_dihedral_sine(x[0], x[1], x[2], x[3]);
}

bool Surgery::load_ring(TetId t, std::uint32_t i, std::uint32_t j) {
  Ring& r = ring_;
  r.a = mesh_.corner(t, i);
  r.b = mesh_.corner(t, j);
  if (mesh_.segment_of(r.a, r.b) != kNoSegment) return false;
  if (mesh_.on_axis(r.a.orbit) && mesh_.on_axis(r.b.orbit)) return false;
  r.tets.clear();
  r.closed = mesh_.ring({t, 0}, r.a, r.b, r.tets);
  const std::size_t m = r.tets.size();
  if (m > kMaxRing || m < (r.closed ? 3u : 2u)) return false;
  r.pa = mesh_.lift(r.a);
  r.pb = mesh_.lift(r.b);
  r.corners.clear();
  r.points.clear();
  const auto off_edge = [&](TetCopy c) {
    std::array<OrbitVertex, 2> o;
    std::size_t n = 0;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const OrbitVertex x = mesh_.corner(c, k);
      if (x != r.a && x != r.b) o[n++] = x;
    }
    return o;
  };
  auto first = off_edge(r.tets[0]);
  const auto second = off_edge(r.tets[1]);
  if (first[0] == second[0] || first[0] == second[1]) std::swap(first[0], first[1]);
  r.corners = {first[0], first[1]};
  for (std::size_t k = 1; k < m; ++k) {
    const auto o = off_edge(r.tets[k]);
    r.corners.push_back(o[0] == r.corners.back() ? o[1] : o[0]);
  }
  if (r.closed) {
    if (r.corners.back() != r.corners.front()) return false;
    r.corners.pop_back();
  }
  for (const OrbitVertex& c : r.corners) r.points.push_back(mesh_.lift(c));
  if (six_volumes(r.pa, r.pb, r.points[0], r.points[1]) < 0) {
    std::swap(r.a, r.b);
    std::swap(r.pa, r.pb);
  }
  return true;
}

double Surgery::triangle_worth(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
  const Point3 &x = ring_.points[i], &y = ring_.points[j], &z = ring_.points[k];
  const double upper = min_dihedral_sine(x, y, z, ring_.pb);
  if (upper <= 0) return upper;
  return std::min(upper, min_dihedral_sine(x, z, y, ring_.pa));
}

bool Surgery::fill_chain(std::span<const std::uint32_t> chain,
                         std::int32_t region,
                         std::int32_t facet,
                         double least) {
  const std::size_t n = chain.size();
  if (n < 3) return false;
  // best[i][j]: the worst tetrahedron of the best filling of the part from i to j.
  double best[kMaxRing + 1][kMaxRing + 1];
  std::uint8_t split[kMaxRing + 1][kMaxRing + 1];
  for (std::size_t i = 0; i + 1 < n; ++i) best[i][i + 1] = 2;
  for (std::size_t span = 2; span < n; ++span) {
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t j = i + span;
      best[i][j] = -1;
      split[i][j] = static_cast<std::uint8_t>(i + 1);
      for (std::size_t k = i + 1; k < j; ++k) {
        const double parts = std::min(best[i][k], best[k][j]);
        if (parts <= std::max(best[i][j], least)) continue;
        const double worth = std::min(parts, triangle_worth(chain[i], chain[k], chain[j]));
        if (worth <= best[i][j]) continue;
        best[i][j] = worth;
        split[i][j] = static_cast<std::uint8_t>(k);
      }
    }
  }
  if (best[0][n - 1] <= least) return false;
  std::array<std::array<std::size_t, 2>, 2 * kMaxRing> todo;
  std::size_t count = 0;
  todo[count++] = {0, n - 1};
  while (count > 0) {
    const auto [i, j] = todo[--count];
    if (j - i < 2) continue;
    const std::size_t k = split[i][j];
    const OrbitVertex x = ring_.corners[chain[i]], y = ring_.corners[chain[k]],
                      z = ring_.corners[chain[j]];
    NewTet upper, lower;
    upper.region = lower.region = region;
    upper.c[0] = x;
    upper.c[1] = y;
    upper.c[2] = z;
    upper.c[3] = ring_.b;
    lower.c[0] = x;
    lower.c[1] = z;
    lower.c[2] = y;
    lower.c[3] = ring_.a;
    if (facet != kNoFacet && i == 0 && j == n - 1) {
      upper.facet[1] = facet;  // opposite y
      lower.facet[2] = facet;
    }
    new_tets_.push_back(upper);
    new_tets_.push_back(lower);
    todo[count++] = {i, k};
    todo[count++] = {k, j};
  }
  return true;
}

bool Surgery::remove_edge(TetId t, std::uint32_t i, std::uint32_t j) {
  if (!load_ring(t, i, j)) return false;
  const Ring& r = ring_;
  const Worth before = worth_of(r.tets);
  const double least = least_shape(before);
  // Subfacets at the edge: none, or two of one facet.
  const auto m = static_cast<std::uint32_t>(r.corners.size());
  std::array<std::uint32_t, 2> at{};
  std::int32_t facet = kNoFacet;
  std::size_t count = 0;
  for (std::size_t k = 0; k < r.tets.size(); ++k) {
    const Tet& tet = mesh_.tet(r.tets[k].t);
    for (std::uint32_t f = 0; f < 4; ++f) {
      const OrbitVertex x = mesh_.corner(r.tets[k], f);
      if (x == r.a || x == r.b || tet.facet[f] == kNoFacet) continue;
      // The face at the edge and the ring's other corner of this tetrahedron.
      const std::uint32_t other = x == r.corners[k] ? (static_cast<std::uint32_t>(k) + 1) % m
                                                    : static_cast<std::uint32_t>(k);
      if (count > 0 && (at[0] == other || (count == 2 && at[1] == other))) continue;
      if (count == 2 || (count == 1 && tet.facet[f] != facet)) return false;
      facet = tet.facet[f];
      at[count++] = other;
    }
  }
  new_tets_.clear();
  std::array<std::uint32_t, kMaxRing + 2> chain;
  if (!r.closed) {
    if (count != 2) return false;
    for (std::uint32_t k = 0; k < m; ++k) chain[k] = k;
    if (!fill_chain({chain.data(), m}, mesh_.tet(r.tets[0].t).region, facet, least)) return false;
  } else if (count == 0) {
    for (std::uint32_t k = 0; k < m; ++k) chain[k] = k;
    if (!fill_chain({chain.data(), m}, mesh_.tet(r.tets[0].t).region, kNoFacet, least)) {
      return false;
    }
  } else {
    if (count != 2) return false;
    for (std::size_t side = 0; side < 2; ++side) {
      std::size_t n = 0;
      std::uint32_t k = at[side];
      const std::int32_t region = mesh_.tet(r.tets[k].t).region;
      while (true) {
        chain[n++] = k;
        if (k == at[1 - side]) break;
        k = (k + 1) % m;
      }
      if (!fill_chain({chain.data(), n}, region, facet, least)) return false;
    }
  }
  if (!accepts(worth_of(new_tets_), before)) return false;
  if (!apply(r.tets, new_tets_)) return false;
  editor_.count_flip();
  return true;
}

bool Surgery::remove_face(TetId t, std::uint32_t i) {
  const Tet& tet = mesh_.tet(t);
  if (tet.facet[i] != kNoFacet || tet.nb[i] == kNoHalfFace) return false;
  const TetCopy here{t, 0}, there = mesh_.neighbour(here, i);
  if (there.t == t) return false;
  const OrbitVertex d = mesh_.corner(here, i), e = mesh_.corner(there, face_of(tet.nb[i]));
  const std::array<OrbitVertex, 3> f = {mesh_.corner(here, kFaceCorners[i][0]),
                                        mesh_.corner(here, kFaceCorners[i][1]),
                                        mesh_.corner(here, kFaceCorners[i][2])};
  const std::array<TetCopy, 2> removed = {here, there};
  const Worth before = worth_of(removed);
  new_tets_.clear();
  const Point3 pd = mesh_.lift(d), pe = mesh_.lift(e);
  for (std::size_t j = 0; j < 3; ++j) {
    const OrbitVertex p = f[j], q = f[(j + 1) % 3];
    const double shape = min_dihedral_sine(pd, mesh_.lift(p), mesh_.lift(q), pe);
    if (shape <= least_shape(before)) return false;
    NewTet n;
    n.c[0] = d;
    n.c[1] = p;
    n.c[2] = q;
    n.c[3] = e;
    n.region = tet.region;
    new_tets_.push_back(n);
  }
  if (!accepts(worth_of(new_tets_), before) || !apply(removed, new_tets_)) return false;
  editor_.count_flip();
  return true;
}

bool Surgery::insert_point(TetId t) {
  const double wanted = lenient_ ? kOpeningShape : kInsertionGain * shapes_[t];
  if (!insertion_.search(t, wanted)) return false;
  const Cavity& cavity = insertion_.best();
  const Worth before = worth_of(cavity.tets);
  Worth now;
  for (const CavityFace& f : cavity.faces) {
    const TetMeasures m = measure_tet(cavity.point, f.points[0], f.points[1], f.points[2]);
    if (is_flat(m)) return false;
    include(now, min_dihedral_sine(cavity.point, f.points[0], f.points[1], f.points[2]), m,
            f.region, exemption_of(f.corners));
  }
  if (!accepts(now, before)) return false;
  if (editor_.insert(cavity, VertexKind::kFree, -1, false) == Editor::kNoVertex) {
    return false;
  }
  note_added();
  return true;
}

}  // namespace symcell::solid
