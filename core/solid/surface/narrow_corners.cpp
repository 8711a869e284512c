#include "core/solid/surface/narrow_corners.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/indexed_surface.hpp"
#include "core/solid/surface/surface_edits.hpp"

namespace symcell::solid {
namespace {

// Where narrow corners are left, the surface may deviate more by this factor.
constexpr double kNarrowRelief = 2;
// But may not get flatter triangles than this for it.
constexpr double kOpenedShape = 0.2;
// Moves that widen one, as shares of a side, in so many directions; and by what factor it must get
// wider to count.
constexpr std::array<double, 4> kSteps = {0.4, 0.2, 0.1, 0.05};
constexpr int kDirections = 8;
constexpr double kWider = 1.03;
// Ways to one neighbour, seen from two triangles, differ by rounding: squared, of their length.
constexpr double kSameWay = 1e-12;
constexpr int kMostPasses = 12;  // at most: one that opens nothing is the last

int narrow_corners(const std::array<Point3, 3>& p) {
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    count += angle_at(p[i], p[(i + 1) % 3], p[(i + 2) % 3]) < kNarrowCorner ? 1 : 0;
  }
  return count;
}

double narrowest(const std::array<Point3, 3>& p) {
  return std::min(
      {angle_at(p[0], p[1], p[2]), angle_at(p[1], p[2], p[0]), angle_at(p[2], p[0], p[1])});
}

}  // namespace

Result<void> NarrowCorners::open() {
  guard_.relax(kNarrowRelief);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    std::size_t done = 0;
    const auto count = static_cast<std::int32_t>(mesh_.surface().triangles.size());
    for (std::int32_t t = 0; t < count; ++t) {
      if (!mesh_.alive(t) || planar(t) || narrow_corners(mesh_.points(t)) == 0) continue;
      SYMCELL_TRY(context_.check());
      done += open_corners_of(t) ? 1 : 0;
    }
    if (done == 0) break;
  }
  return {};
}

// By a flip, a collapse, or moves of vertices.
bool NarrowCorners::open_corners_of(std::int32_t t) {
  for (std::int32_t side = 0; side < 3; ++side) {
    const auto plan = plan_inner_flip(mesh_, t, side);
    if (!plan) continue;
    const std::array<std::int32_t, 2> gone{plan->changed[0].id, plan->changed[1].id};
    if (!opens(gone, plan->changed)) continue;
    mesh_.flip(*plan);
    return true;
  }
  for (std::int32_t side = 0; side < 3; ++side) {
    for (const bool to_start : {false, true}) {
      if (!mesh_.may_leave(t, side, !to_start)) continue;
      const auto plan = mesh_.plan_collapse(t, side, to_start);
      if (!plan || !opens(gone_of(*plan), plan->changed)) continue;
      mesh_.collapse(*plan);
      return true;
    }
  }
  bool moved = false;
  for (const OrbitVertex& corner : mesh_.surface().triangles[t]) {
    if (!mesh_.alive(t) || narrow_corners(mesh_.points(t)) == 0) break;
    for (const Point3& place : places_near(corner.orbit)) {
      if (!widens(corner.orbit, place)) continue;
      mesh_.move(corner.orbit, place);
      moved = true;
    }
  }
  return moved;
}

// Where a vertex may go: on the old surface around its place, or along the crease or cut that it
// lies on.
std::vector<Point3> NarrowCorners::places_near(std::int32_t v) const {
  std::vector<Point3> places;
  if (mesh_.surface().on_axis[v] != 0) return places;
  const Point3 from = mesh_.surface().points[v];
  std::vector<Point3> marked;  // ways to the neighbours along marked sides
  std::vector<Point3> all;
  Point3 normal;
  bool flat = false;
  for (const std::int32_t t : mesh_.star(v)) {
    flat = flat || planar(t);
    const auto p = mesh_.points(t);
    normal = normal + mesh_.in_frame_of(v, t, area_normal(p[0], p[1], p[2]));
    for (std::int32_t i = 0; i < 3; ++i) {
      const std::int32_t j = (i + 1) % 3;
      const OrbitVertex a = mesh_.surface().triangles[t][i], b = mesh_.surface().triangles[t][j];
      if (a.orbit != v && b.orbit != v) continue;
      const Point3 way = mesh_.in_frame_of(v, t, a.orbit == v ? p[j] - p[i] : p[i] - p[j]);
      all.push_back(way);
      const bool known = std::any_of(marked.begin(), marked.end(), [&](const Point3& m) {
        return squared_distance(m, way) <= kSameWay * dot(way, way);
      });
      if (mesh_.mark(t, i) != 0 && !known) marked.push_back(way);
    }
  }
  if (marked.size() == 2) {
    for (const double step : kSteps) {
      for (const Point3& way : marked) places.push_back(from + step * way);
    }
  }
  if (!marked.empty() || flat || mesh_.surface().on_cut[v] != 0 || all.empty()) return places;
  const Point3 across = cross(normal, all.front());
  const double sine = length(across), size = length(all.front());
  if (!(sine > 0)) return places;
  const Point3 u = (size / sine) * across,
               w = (size / (length(normal) * sine)) * cross(normal, across);
  for (const double step : kSteps) {
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 2 * std::numbers::pi * k / kDirections;
      const Point3 aim = from + step * (std::cos(angle) * u + std::sin(angle) * w);
      const auto hit = guard_.nearest(aim, 10 * guard_.most());
      if (hit.triangle >= 0) places.push_back(hit.point);
    }
  }
  return places;
}

// Whether the star has fewer narrow corners with its vertex there, or as many and a wider worst
// one; if so, the guard knows of it.
bool NarrowCorners::widens(std::int32_t v, Point3 place) {
  const std::vector<std::int32_t> gone = mesh_.star(v);
  const std::vector<PlannedTriangle> planned = mesh_.plan_move(v, place);
  int before = 0, after = 0;
  double worst_before = 4, worst_after = 4, flattest = 1, allowed = kOpenedShape;
  for (const std::int32_t t : gone) {
    const auto p = mesh_.points(t);
    allowed = std::min(allowed, shape_of(p));
    if (planar(t)) continue;
    before += narrow_corners(p);
    worst_before = std::min(worst_before, narrowest(p));
  }
  for (const PlannedTriangle& p : planned) {
    if (planar(p.id) && !keeps_plane(mesh_, p, off_)) return false;
    flattest = std::min(flattest, shape_of(p.points));
    if (planar(p.id)) continue;
    after += narrow_corners(p.points);
    worst_after = std::min(worst_after, narrowest(p.points));
  }
  if (after > before || flattest < allowed) return false;
  if (worst_after <= kWider * worst_before && after == before) return false;
  if (!guard_.allows(gone, planned)) return false;
  guard_.commit(gone, planned);
  return true;
}

bool NarrowCorners::opens(std::span<const std::int32_t> gone,
                          std::span<const PlannedTriangle> planned) {
  int before = 0, after = 0;
  double worst = 1, least = kOpenedShape;
  for (const std::int32_t t : gone) {
    const auto p = mesh_.points(t);
    if (!planar(t)) before += narrow_corners(p);
    least = std::min(least, shape_of(p));
  }
  for (const PlannedTriangle& p : planned) {
    if (!planar(p.id)) after += narrow_corners(p.points);
    if (planar(p.id) && !keeps_plane(mesh_, p, off_)) return false;
    worst = std::min(worst, shape_of(p.points));
  }
  if (after >= before || worst < least || !guard_.allows(gone, planned)) return false;
  guard_.commit(gone, planned);
  return true;
}

}  // namespace symcell::solid
