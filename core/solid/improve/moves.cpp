// Moves of single vertices.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/solid/improve/surgery.hpp"

namespace symcell::solid {
namespace {

// Stars without a sine below this (25 degrees) and within all bounds are left to the mean:
// searching on takes a third of the time and makes meshes no smaller.
constexpr double kGoodTet = 0.42;
// Steps of a pattern search, as shares of the shortest edge at the vertex.
constexpr std::array<double, 4> kSteps = {0.3, 0.15, 0.07, 0.03};

}  // namespace

// Onto the line of its segment or the plane of its facet.
Point3 Surgery::constrain(VertexId v, Point3 p) const {
  const Point3 x = mesh_.point(v);
  if (mesh_.kind(v) == VertexKind::kFree) return p;
  const double along = dot(p - x, direction_);
  if (mesh_.kind(v) == VertexKind::kFacet) return p - along * direction_;
  return mesh_.on_axis(v) ? Point3{0, 0, x.z + along * direction_.z} : x + along * direction_;
}

// What holds the vertex: the line of its subsegments, the plane of its subfacets. Moves keep to the line or
// plane exactly as far as doubles allow, and the ends of its segment are its neighbours'.
std::optional<double> Surgery::find_hold(VertexId v) {
  const VertexKind kind = mesh_.kind(v);
  direction_ = {0, 0, 0};
  Point3 normal;
  double reach2 = std::numeric_limits<double>::infinity();
  for (const StarTet& s : star_tets()) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if ((s.own >> i & 1) == 0 || s.c[i].exponent != 0) continue;
      for (std::uint32_t j = 0; j < 4; ++j) {
        if (j == i) continue;
        reach2 = std::min(reach2, squared_distance(s.p[i], s.p[j]));
        if (kind == VertexKind::kSegment && mesh_.segment_of(s.c[i], s.c[j]) != kNoSegment) {
          const Point3 d = s.p[j] - mesh_.point(v);
          if (dot(d, d) > dot(direction_, direction_)) direction_ = d;
        }
      }
    }
  }
  if (kind == VertexKind::kFacet) {
    for (std::size_t n = 0; n < star_.size(); ++n) {
      const Tet& t = mesh_.tet(star_[n].t);
      for (std::uint32_t f = 0; f < 4; ++f) {
        if (t.facet[f] == kNoFacet || t.facet[f] != mesh_.parent(v)) continue;
        const auto& c = star_tets_[n];
        bool at = false;
        for (const std::uint32_t k : kFaceCorners[f])
          at = at || (c.c[k].orbit == v && c.c[k].exponent == 0);
        if (!at) continue;
        const Point3 m = cross(c.p[kFaceCorners[f][1]] - c.p[kFaceCorners[f][0]],
                               c.p[kFaceCorners[f][2]] - c.p[kFaceCorners[f][0]]);
        if (dot(m, m) > dot(normal, normal)) normal = m;
      }
    }
    direction_ = normal;
  }
  if (kind != VertexKind::kFree) {
    const double l = length(direction_);
    if (!(l > 0)) return std::nullopt;
    direction_ = (1 / l) * direction_;
  }
  return std::sqrt(reach2);
}

bool Surgery::smooth(VertexId v) {
  const VertexKind kind = mesh_.kind(v);
  if (kind == VertexKind::kInput || kind == VertexKind::kDeleted) return false;
  if (!load_star(v)) return false;
  const Point3 x = mesh_.point(v);
  const std::optional<double> reach = find_hold(v);
  if (!reach) return false;
  const Worth before = star_worth();
  Worth best = before;
  Point3 at = x;
  const auto attempt = [&](Point3 p) {
    p = constrain(v, p);
    const Worth limits{floor_of(best), std::max(1.0, best.excess),
                       best.excess > 1 ? kFar : std::max(1.0, best.exempt)};
    const Worth w = star_worth_at(p, limits);
    if (w.shape <= limits.shape || !better(w, best)) return false;
    best = w;
    at = p;
    return true;
  };
  // The mean of the tetrahedra's centroids weighted by volume, then a pattern search.
  Point3 sum;
  double weight = 0;
  for (const StarTet& s : star_tets()) {
    const double volume = six_volumes(s.p[0], s.p[1], s.p[2], s.p[3]);
    sum = sum + 0.25 * volume * (s.p[0] + s.p[1] + s.p[2] + s.p[3]);
    weight += volume;
  }
  if (weight > 0) {
    const Point3 mean = (1 / weight) * sum;
    if (!attempt(mean)) static_cast<void>(attempt(0.5 * (x + mean)));
  }
  const bool search = is_broken(best) || best.shape < kGoodTet;
  // Unit vectors: both ways along the axes, and one out of their planes.
  constexpr std::array<Point3, 7> kWays = {
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0.577, 0.577, 0.577}}};
  for (const double step : kSteps) {
    if (!search) break;
    for (const Point3& way : kWays) {
      static_cast<void>(attempt(at + step * *reach * way));
    }
  }
  if (at == x) return false;
  mesh_.move_vertex(v, at);
  ++edits_;
  touched_.clear();
  for (const TetCopy& c : star_) {
    if (std::find(touched_.begin(), touched_.end(), c.t) != touched_.end()) continue;
    refresh(c.t);
    touched_.push_back(c.t);
  }
  editor_.count_move();
  return true;
}

}  // namespace symcell::solid
