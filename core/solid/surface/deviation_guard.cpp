#include "core/solid/surface/deviation_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace symcell::solid {
namespace {

// A new triangle faces within 45 degrees of the old surface; one thinner than two deviations has no
// normal worth more than its side.
constexpr double kFacingCosine = 0.7;
constexpr double kThinFacingCosine = 0.1;
constexpr double kThinDeviations = 2;
// Points on a new side that are looked at, by their shares of the way.
constexpr double kSideShares[] = {1.0 / 3, 2.0 / 3};

}  // namespace

DeviationGuard::DeviationGuard(const QuotientSurface& surface, double most)
    : most_(most), normals_(surface.normals) {
  const RotationTable rotations(surface.fold);
  std::vector<Point3> corners;
  std::vector<Triangle> triangles;
  of_triangle_.resize(surface.triangles.size());
  std::vector<bool> sampled(surface.points.size(), false);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto first = static_cast<std::int32_t>(corners.size());
    Point3 sum;
    for (const OrbitVertex& v : surface.triangles[t]) {
      const Point3 p = corner_point(surface, rotations, v);
      corners.push_back(p);
      sum = sum + p;
      if (sampled[v.orbit]) continue;
      sampled[v.orbit] = true;
      of_triangle_[t].push_back(static_cast<std::int32_t>(samples_.size()));
      samples_.push_back(p);
    }
    triangles.push_back({first, first + 1, first + 2});
    if (surface.patch[t] >= 0) continue;  // its corners bound all of a flat part
    of_triangle_[t].push_back(static_cast<std::int32_t>(samples_.size()));
    samples_.push_back((1.0 / 3) * sum);
  }
  tree_ = TriangleTree(corners, triangles);
}

void DeviationGuard::renumber(const std::vector<std::int32_t>& old) {
  std::vector<std::vector<std::int32_t>> renumbered;
  renumbered.reserve(old.size());
  for (const std::int32_t t : old) renumbered.push_back(std::move(of_triangle_[t]));
  of_triangle_ = std::move(renumbered);
  std::vector<std::int32_t> hints;
  hints.reserve(old.size());
  for (const std::int32_t t : old) hints.push_back(hint_of(t));
  hints_ = std::move(hints);
}

std::int32_t& DeviationGuard::hint_of(std::int32_t triangle) {
  const auto needed = static_cast<std::size_t>(triangle) + 1;
  if (hints_.size() < needed) hints_.resize(needed, -1);
  return hints_[triangle];
}

// By three points that integrate quadratic heights exactly.
double DeviationGuard::mean_height(std::int32_t triangle, const std::array<Point3, 3>& points) {
  const Point3 n = area_normal(points[0], points[1], points[2]);
  const Point3 sum = points[0] + points[1] + points[2];
  double heights = 0;
  for (const Point3& corner : points) {
    const Point3 p = (1.0 / 6) * sum + 0.5 * corner;
    const auto hit = tree_.nearest(p, 2 * most_, hint_of(triangle));
    if (hit.triangle < 0 || dot(normals_[hit.triangle], n) <= 0) continue;
    heights += dot(n, hit.point - p);
  }
  return heights / (3 * length(n));
}

bool DeviationGuard::lies_on_old_surface(const PlannedTriangle& triangle) {
  const auto& [a, b, c] = triangle.points;
  const Point3 n = area_normal(a, b, c);
  const double twice = length(n);
  if (!(twice > 0)) return false;
  const double longest =
      std::sqrt(std::max({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)}));
  const double facing =
      (twice < kThinDeviations * most_ * longest ? kThinFacingCosine : kFacingCosine) * twice;
  const Point3 centre = (1.0 / 3) * (a + b + c);
  std::int32_t& hint = hint_of(triangle.id);
  const auto hit = tree_.nearest(centre, most_, hint);
  if (hit.triangle < 0 || dot(normals_[hit.triangle], n) < facing) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    // A new side is met once from either triangle; one that is not new was looked at before.
    if (triangle.corners[i].orbit < triangle.corners[(i + 1) % 3].orbit) continue;
    const Point3 from = triangle.points[i], way = triangle.points[(i + 1) % 3] - from;
    for (const double share : kSideShares) {
      if (!tree_.within(from + share * way, most_, hint)) return false;
    }
  }
  return true;
}

bool DeviationGuard::answers(std::span<const std::int32_t> gone,
                             std::span<const PlannedTriangle> planned,
                             double reach) {
  answers_.clear();
  for (const std::int32_t t : gone) {
    for (const std::int32_t sample : of_triangle_[t]) {
      double best = std::numeric_limits<double>::infinity();
      std::int32_t at = -1;
      for (std::size_t k = 0; k < planned.size(); ++k) {
        const auto& [a, b, c] = planned[k].points;
        const Point3 p = samples_[sample];
        const double squared = squared_distance(p, closest_point(p, a, b, c));
        if (squared >= best) continue;
        best = squared;
        at = static_cast<std::int32_t>(k);
      }
      if (at < 0 || best > reach * reach) return false;
      answers_.emplace_back(sample, at);
    }
  }
  return true;
}

bool DeviationGuard::allows(std::span<const std::int32_t> gone,
                            std::span<const PlannedTriangle> planned) {
  for (const PlannedTriangle& p : planned) {
    if (!lies_on_old_surface(p)) return false;
  }
  return answers(gone, planned, most_);
}

void DeviationGuard::follow(std::span<const std::int32_t> gone,
                            std::span<const PlannedTriangle> planned) {
  static_cast<void>(answers(gone, planned, std::numeric_limits<double>::infinity()));
}

void DeviationGuard::commit(std::span<const std::int32_t> gone,
                            std::span<const PlannedTriangle> planned) {
  for (const PlannedTriangle& p : planned) {
    const auto needed = static_cast<std::size_t>(p.id) + 1;
    if (of_triangle_.size() < needed) of_triangle_.resize(needed);
  }
  for (const std::int32_t t : gone) of_triangle_[t].clear();
  for (const auto& [sample, at] : answers_) of_triangle_[planned[at].id].push_back(sample);
}

}  // namespace symcell::solid
