#include "core/solid/improve/insertion_cavity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace symcell::solid {
namespace {

// Cavities that grew this far are not going to get better.
constexpr int kMostGrown = 24;
// Steps of the search for the point's place, as shares of the poor tetrahedron's longest edge, and
// how often one is repeated while it helps.
constexpr std::array<double, 3> kCoarseSteps = {0.3, 0.15, 0.07};
constexpr std::array<double, 5> kFineSteps = {0.1, 0.05, 0.025, 0.012, 0.006};
constexpr int kMostTurns = 4;
// Along the axes and to the corners of a cube; all of length 1.
constexpr double kDiagonal = 0.577;  // 1 / sqrt(3)
constexpr std::array<Point3, 14> kWays = {{{1, 0, 0},
                                           {-1, 0, 0},
                                           {0, 1, 0},
                                           {0, -1, 0},
                                           {0, 0, 1},
                                           {0, 0, -1},
                                           {kDiagonal, kDiagonal, kDiagonal},
                                           {-kDiagonal, -kDiagonal, -kDiagonal},
                                           {kDiagonal, kDiagonal, -kDiagonal},
                                           {-kDiagonal, -kDiagonal, kDiagonal},
                                           {kDiagonal, -kDiagonal, kDiagonal},
                                           {-kDiagonal, kDiagonal, -kDiagonal},
                                           {-kDiagonal, kDiagonal, kDiagonal},
                                           {kDiagonal, -kDiagonal, -kDiagonal}}};
// A tetrahedron that breaks a bound counts as one of so small a share of its shape.
constexpr double kBrokenShare = 0.5;

bool has(const CavityFace& f, OrbitVertex x) {
  return f.corners[0] == x || f.corners[1] == x || f.corners[2] == x;
}

}  // namespace

double InsertionCavity::worth(Point3 p, const CavityFace& f, double least) const {
  const double shape = min_dihedral_sine(p, f.points[0], f.points[1], f.points[2]);
  if (shape <= least || shape <= 0) return shape;
  const TetMeasures m = measure_tet(p, f.points[0], f.points[1], f.points[2]);
  const double excess = criteria_.excess(m, f.region, Exemption::kNone);
  return excess > 1 ? shape * kBrokenShare / excess : shape;
}

// The worst of the star of p; gives up where one is at most `least`, and looks there earlier next
// time.
double InsertionCavity::star_worth(Point3 p, double least) {
  double worst = 2;
  for (std::size_t i = 0; i < now_.faces.size(); ++i) {
    worst = std::min(worst, worth(p, now_.faces[i], least));
    if (worst > least) continue;
    std::swap(now_.faces[i], now_.faces[i / 2]);
    std::swap(sides_[i], sides_[i / 2]);
    break;
  }
  return worst;
}

double InsertionCavity::place_point(std::span<const double> steps, double reach) {
  double best = star_worth(now_.point, -std::numeric_limits<double>::infinity());
  for (const double step : steps) {
    bool moved = true;
    for (int turn = 0; moved && turn < kMostTurns; ++turn) {
      moved = false;
      for (const Point3& way : kWays) {
        const Point3 q = now_.point + step * reach * way;
        const double found = star_worth(q, best);
        if (found <= best) continue;
        best = found;
        now_.point = q;
        moved = true;
      }
    }
  }
  return best;
}

Point3 InsertionCavity::centroid() const {
  Point3 sum;
  double weight = 0;
  for (const TetCopy& c : now_.tets) {
    const auto x = editor_.points(c);
    const double volume = editor_.measures(c.t).volume;
    sum = sum + 0.25 * volume * (x[0] + x[1] + x[2] + x[3]);
    weight += volume;
  }
  return (1 / weight) * sum;
}

bool InsertionCavity::holds(TetCopy c) const {
  const Tet& t = mesh_.tet(c.t);
  return t.stamp == epoch_ && now_.tets[static_cast<std::size_t>(t.scratch)].e == c.e;
}

bool InsertionCavity::may_cross(std::size_t face) const {
  const CavityFace& f = now_.faces[face];
  if (f.facet != kNoFacet) return false;
  const Tet& owner = mesh_.tet(now_.tets[f.owner].t);
  const HalfFace behind = owner.nb[sides_[face]];
  // In the cavity already: as another copy.
  return behind != kNoHalfFace && mesh_.tet(tet_of(behind)).stamp != epoch_;
}

std::size_t InsertionCavity::worst_crossable() const {
  std::size_t at = now_.faces.size();
  double worst = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < now_.faces.size(); ++i) {
    if (!may_cross(i)) continue;
    const CavityFace& f = now_.faces[i];
    const double shape = min_dihedral_sine(now_.point, f.points[0], f.points[1], f.points[2]);
    if (shape >= worst) continue;
    worst = shape;
    at = i;
  }
  return at;
}

void InsertionCavity::drop_face(std::size_t face) {
  now_.faces[face] = now_.faces.back();
  now_.faces.pop_back();
  sides_[face] = sides_.back();
  sides_.pop_back();
}

// Adds a tetrahedron; the face it was entered through, if any (< 4), is no longer of the boundary.
void InsertionCavity::add(TetCopy c, std::uint32_t entered) {
  Tet& t = mesh_.tet(c.t);
  const auto index = static_cast<std::uint32_t>(now_.tets.size());
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i == entered) continue;
    if (t.nb[i] != kNoHalfFace && holds(mesh_.neighbour(c, i))) {
      const auto other = static_cast<std::uint32_t>(mesh_.tet(tet_of(t.nb[i])).scratch);
      for (std::size_t f = 0; f < now_.faces.size(); ++f) {
        if (now_.faces[f].owner != other || sides_[f] != face_of(t.nb[i])) continue;
        drop_face(f);
        break;
      }
      continue;
    }
    CavityFace face;
    for (std::size_t j = 0; j < 3; ++j) {
      face.corners[j] = mesh_.corner(c, kFaceCorners[i][j]);
      face.points[j] = mesh_.lift(face.corners[j]);
    }
    face.facet = t.facet[i];
    face.region = t.region;
    face.owner = index;
    now_.faces.push_back(face);
    sides_.push_back(i);
  }
  t.stamp = epoch_;
  t.scratch = static_cast<std::int32_t>(index);
  now_.tets.push_back(c);
}

// Takes in the tetrahedron behind a face, unless that would swallow a subfacet.
bool InsertionCavity::grow_across(std::size_t face) {
  const TetCopy from = now_.tets[now_.faces[face].owner];
  const std::uint32_t side = sides_[face];
  const std::uint32_t entered = face_of(mesh_.tet(from.t).nb[side]);
  const TetCopy n = mesh_.neighbour(from, side);
  const Tet& t = mesh_.tet(n.t);
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (t.facet[i] == kNoFacet || t.nb[i] == kNoHalfFace) continue;
    if (holds(mesh_.neighbour(n, i))) return false;
  }
  drop_face(face);
  add(n, entered);
  return true;
}

// Whether every vertex and subsegment of the cavity is on its boundary.
bool InsertionCavity::loses_nothing() const {
  const auto kept = [&](auto&& on_face) {
    return std::any_of(now_.faces.begin(), now_.faces.end(), on_face);
  };
  for (const TetCopy& c : now_.tets) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const OrbitVertex x = mesh_.corner(c, i);
      if (!kept([&](const CavityFace& f) { return has(f, x); })) return false;
    }
    for (const auto& e : kEdgeCorners) {
      const OrbitVertex a = mesh_.corner(c, e[0]), b = mesh_.corner(c, e[1]);
      if (mesh_.segment_of(a, b) == kNoSegment) continue;
      if (!kept([&](const CavityFace& f) { return has(f, a) && has(f, b); })) return false;
    }
  }
  return true;
}

bool InsertionCavity::search(TetId t, double wanted) {
  epoch_ = mesh_.new_epoch();
  now_ = {};
  sides_.clear();
  now_.where.at = {t, 0};
  now_.seeds = 1;
  add({t, 0}, 4);
  const auto x = editor_.points({t, 0});
  now_.point = 0.25 * (x[0] + x[1] + x[2] + x[3]);
  const double reach = std::sqrt(editor_.measures(t).longest2);
  best_.faces.clear();
  double best = wanted;
  for (int grown = 0; grown < kMostGrown; ++grown) {
    const std::size_t face = worst_crossable();
    if (face == now_.faces.size() || !grow_across(face)) break;
    const double here = star_worth(now_.point, -std::numeric_limits<double>::infinity());
    const Point3 middle = centroid();
    if (star_worth(middle, here) > here) now_.point = middle;
    const double found = place_point(kCoarseSteps, reach);
    if (found <= best || !loses_nothing()) continue;
    best = found;
    best_ = now_;
  }
  if (best_.faces.empty()) return false;
  now_ = best_;
  sides_.resize(now_.faces.size());  // order no longer matters
  static_cast<void>(place_point(kFineSteps, reach));
  best_ = now_;
  return true;
}

}  // namespace symcell::solid
