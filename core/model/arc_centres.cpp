#include "core/model/arc_centres.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/index.hpp"
#include "core/geometry/arc.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/model/describe.hpp"

namespace symcell {
namespace {

// Of the radius: what files with seven digits keep.
constexpr double kSameRadius = 1e-6;

std::vector<Point3> raised(const std::vector<Point2>& points) {
  std::vector<Point3> result;
  result.reserve(points.size());
  for (const Point2 p : points) result.push_back({p.x, p.y, 0});
  return result;
}

}  // namespace

Result<void> resolve_arcs(std::span<const ArcCentre> centres, Pslg& pslg) {
  const auto count = static_cast<std::int32_t>(pslg.vertices.size());
  const auto known = [&](std::int32_t v) { return v >= 0 && v < count; };
  pslg.bulges.resize(centres.empty() ? pslg.bulges.size() : pslg.segments.size(), 0);
  std::optional<PointTree> tree;  // of the vertices given
  for (const ArcCentre& arc : centres) {
    const PslgSegment segment = pslg.segments[at(arc.segment)];
    if (!known(segment.a) || !known(segment.b)) continue;
    const Point2 a = pslg.vertices[at(segment.a)], b = pslg.vertices[at(segment.b)];
    const double r = distance(a, arc.centre), s = distance(b, arc.centre);
    if (!(std::abs(r - s) <= kSameRadius * std::max(r, s)) || r == 0) {
      return fail(ErrorCode::kDegenerateGeometry,
                  "the center of segment " + std::to_string(arc.segment) + " at " +
                      describe_point(arc.centre) + " is " + describe_rounded(r) + " from vertex " +
                      std::to_string(segment.a) + " and " + describe_rounded(s) + " from vertex " +
                      std::to_string(segment.b) +
                      "; correct it, or give the bulge: the tangent of a quarter of the angle",
                  {arc.segment}, "/segments/" + std::to_string(arc.segment) + "/center");
    }
    if (segment.a != segment.b) {
      pslg.bulges[at(arc.segment)] = bulge_about(a, b, arc.centre);
      continue;
    }
    const Point2 p = arc.centre + arc.centre - a;
    if (!tree) tree.emplace(raised(pslg.vertices));
    const PointTree::Hit there = tree->nearest({p.x, p.y, 0});
    const bool taken = there.distance <= kSameRadius * r;
    const std::int32_t opposite =
        taken ? there.point : static_cast<std::int32_t>(pslg.vertices.size());
    if (!taken) pslg.vertices.push_back(p);
    pslg.segments[at(arc.segment)].b = opposite;
    pslg.segments.push_back({opposite, segment.a, segment.marker});
    pslg.bulges[at(arc.segment)] = 1;
    pslg.bulges.push_back(1);
  }
  return {};
}

}  // namespace symcell
