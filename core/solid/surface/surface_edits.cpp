#include "core/solid/surface/surface_edits.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

double shape_of(const std::array<Point3, 3>& p) {
  const double longest = std::max(
      {squared_distance(p[0], p[1]), squared_distance(p[1], p[2]), squared_distance(p[2], p[0])});
  return longest > 0 ? length(area_normal(p[0], p[1], p[2])) / longest : 0;
}

double angle_at(Point3 x, Point3 a, Point3 b) {
  return std::atan2(length(cross(a - x, b - x)), dot(a - x, b - x));
}

bool keeps_plane(const EditableSurface& mesh, const PlannedTriangle& p, double off) {
  const Plane plane = mesh.plane(p.id);
  for (const Point3& q : p.points) {
    if (std::abs(plane.height(q)) > off) return false;
  }
  return dot(area_normal(p.points[0], p.points[1], p.points[2]), plane.normal) > 0;
}

std::optional<FlipPlan> plan_inner_flip(const EditableSurface& mesh,
                                        std::int32_t t,
                                        std::int32_t side) {
  if (mesh.mark(t, side) != 0) return std::nullopt;
  const QuotientNeighbour other = mesh.across(t, side);
  if (other.triangle < 0 || other.exponent != 0) return std::nullopt;
  const QuotientSurface& s = mesh.surface();
  if (s.patch[t] != s.patch[other.triangle]) return std::nullopt;
  if (s.patch[t] >= 0 && s.frame[t] != s.frame[other.triangle]) return std::nullopt;
  return mesh.plan_flip(t, side);
}

std::vector<std::int32_t> gone_of(const CollapsePlan& plan) {
  std::vector<std::int32_t> gone(plan.removed.begin(), plan.removed.end());
  for (const PlannedTriangle& p : plan.changed) gone.push_back(p.id);
  return gone;
}

}  // namespace symcell::solid
