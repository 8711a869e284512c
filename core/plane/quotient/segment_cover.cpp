#include "core/plane/quotient/segment_cover.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/geometry/tolerances.hpp"

namespace symcell::plane {
namespace {}  // namespace

SegmentCover measure_segment_cover(const QuotientTriangulation& mesh) {
  SegmentCover cover;
  std::int64_t triangles = 0, open = 0, vertices = 0;
  std::vector<char> used(mesh.vertex_slots(), 0);
  for (TriangleId t = 0; t < mesh.triangle_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    ++triangles;
    const Triangle& tri = mesh.triangle(t);
    const Point2 p[3] = {mesh.corner_point(tri, 0), mesh.corner_point(tri, 1),
                         mesh.corner_point(tri, 2)};
    cover.area += 0.5 * cross(p[1] - p[0], p[2] - p[0]);
    for (std::uint32_t j = 0; j < 3; ++j) {
      used[static_cast<std::size_t>(tri.v[j])] = 1;
      const HalfEdge h = 3 * t + j, g = tri.nb[j];
      open += g == kNoHalfEdge ? 1 : 0;
      if (tri.seg[j] == kNoSubsegment || (g != kNoHalfEdge && g < h)) continue;
      const auto parent = static_cast<std::size_t>(mesh.subsegment(tri.seg[j]).parent);
      if (cover.segments.size() <= parent) cover.segments.resize(parent + 1);
      SegmentCover::Segment& s = cover.segments[parent];
      (g == kNoHalfEdge ? s.one_sided : s.two_sided) += distance(p[next3(j)], p[prev3(j)]);
    }
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    vertices += static_cast<VertexId>(v) == mesh.centre() ? 1 : mesh.fold();
  }
  const std::int64_t edges = (3 * triangles + open) / 2;
  cover.euler = vertices + mesh.fold() * (triangles - edges);
  return cover;
}

Result<void> compare_segment_covers(const SegmentCover& wanted, const SegmentCover& found) {
  const auto differ = [](double a, double b, double scale) {
    return std::abs(a - b) > kSumRoundingRel * (std::abs(b) + scale);
  };
  double longest = 0;
  for (const auto& s : wanted.segments) longest = std::max({longest, s.one_sided, s.two_sided});
  for (std::size_t i = 0; i < std::max(wanted.segments.size(), found.segments.size()); ++i) {
    const auto at = [i](const SegmentCover& c) {
      return i < c.segments.size() ? c.segments[i] : SegmentCover::Segment{};
    };
    const auto w = at(wanted), f = at(found);
    if (differ(f.one_sided, w.one_sided, longest) || differ(f.two_sided, w.two_sided, longest)) {
      return fail(ErrorCode::kInternal,
                  "mesh check 'segments': segment " + std::to_string(i) + " has a length of " +
                      std::to_string(f.one_sided) + " in place of " + std::to_string(w.one_sided) +
                      " at the boundary, " + std::to_string(f.two_sided) + " in place of " +
                      std::to_string(w.two_sided) + " inside");
    }
  }
  if (differ(found.area, wanted.area, 0)) {
    return fail(ErrorCode::kInternal, "mesh check 'segments': area " + std::to_string(found.area) +
                                          " in place of " + std::to_string(wanted.area));
  }
  if (found.euler != wanted.euler) {
    return fail(ErrorCode::kInternal, "mesh check 'segments': Euler characteristic " +
                                          std::to_string(found.euler) + " in place of " +
                                          std::to_string(wanted.euler));
  }
  return {};
}

}  // namespace symcell::plane
