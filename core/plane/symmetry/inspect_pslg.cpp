// `inspect_pslg`: the symmetry found and the plain measures of the domain.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/base/index.hpp"
#include "core/plane/symmetry/prepared_pslg.hpp"
#include "core/plane/symmetry/symmetrise.hpp"
#include "core/plane/symmetry/symmetrise_subdomains.hpp"

namespace symcell::plane {
namespace {

// Faces that share a piece of segment are one component.
std::size_t count_components(const Subdomains& subdomains) {
  std::vector<std::int32_t> parent(subdomains.faces.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](std::int32_t f) {
    while (parent[at(f)] != f) f = parent[at(f)] = parent[at(parent[at(f)])];
    return f;
  };
  const PlanarMap& map = subdomains.map;
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    const std::int32_t left = map.face[2 * p];
    const std::int32_t right = map.face[2 * p + 1];
    if (!subdomains.faces[at(left)].meshed || !subdomains.faces[at(right)].meshed) continue;
    parent[at(root(left))] = root(right);
  }
  std::size_t result = 0;
  for (std::size_t f = 0; f < parent.size(); ++f) {
    if (subdomains.faces[f].meshed && root(static_cast<std::int32_t>(f)) == static_cast<int>(f)) {
      ++result;
    }
  }
  return result;
}

// The smallest angle that the domain has between two segments that follow each other round a
// vertex; the full turn at a loose end is none. 360 if there is no other.
double min_angle_deg(const Pslg& pslg, const Subdomains& subdomains) {
  const PlanarMap& map = subdomains.map;
  double smallest = 2 * std::numbers::pi;
  for (std::int32_t h = 0; at(h) < map.next.size(); ++h) {
    const std::int32_t g = map.next[at(h)];
    if (g == (h ^ 1) || !subdomains.left_of(h).meshed) continue;
    const Point2 v = pslg.vertices[at(map.target(h))];
    const Point2 in = pslg.vertices[at(map.origin(h))] - v;
    const Point2 out = pslg.vertices[at(map.target(g))] - v;
    double angle = std::atan2(cross(out, in), dot(out, in));
    if (angle < 0) angle += 2 * std::numbers::pi;
    smallest = std::min(smallest, angle);
  }
  return smallest * 180 / std::numbers::pi;
}

}  // namespace

Result<PslgInspection> inspect_pslg(const Pslg& pslg,
                                    const MeshOptions& options,
                                    ExecutionContext& context) {
  auto subdomains = make_subdomains(pslg, context);
  if (!subdomains) return error_of(subdomains);
  std::vector<FoldFit> ladder;
  const auto symmetric = symmetrise_subdomains(pslg, *subdomains, options, &ladder, context);
  if (!symmetric) return error_of(symmetric);

  const PreparedPslg prepared = prepare_pslg(pslg, *subdomains, options.ignore_markers);
  PslgInspection result;
  result.fold = symmetric->fold;
  result.geometry_fold = symmetric->geometry_fold;
  result.centre = symmetric->centre;
  result.symmetry_error_rel = symmetric->symmetry_error_rel;
  result.area = prepared.area;
  result.diameter = prepared.diameter;
  result.bbox_min = prepared.box_low;
  result.bbox_max = prepared.box_high;
  result.vertices = pslg.vertices.size();
  result.segments = pslg.segments.size();
  result.holes = pslg.holes.size();
  result.regions = pslg.regions.size();
  result.components = count_components(*subdomains);
  result.min_input_angle_deg = min_angle_deg(pslg, *subdomains);
  for (const FoldFit& fit : ladder) {
    FoldCandidate rung{fit.fold, fit.error / prepared.diameter, fit.accepted};
    rung.ruled_out = fit.accepted && !fit.kept;
    if (fit.worst_point >= 0) {
      const Point2 worst = prepared.points[at(fit.worst_point)];
      rung.worst = Point3{worst.x, worst.y, 0};
    }
    result.folds.push_back(rung);
  }
  result.warnings = symmetric->warnings;
  return result;
}

}  // namespace symcell::plane
