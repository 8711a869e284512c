#include "core/plane/input/near_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/index.hpp"
#include "core/geometry/segment_index.hpp"

namespace symcell::plane {
namespace {

struct Cut {
  std::int32_t segment = 0;
  double along = 0;
  std::int32_t vertex = 0;
};

std::vector<Cut> find_cuts(std::span<const Point2> vertices,
                           std::span<const PslgSegment> segments,
                           double radius) {
  std::vector<IndexedSegment> positions;
  positions.reserve(segments.size());
  for (const PslgSegment& s : segments) positions.push_back({vertices[at(s.a)], vertices[at(s.b)]});
  const SegmentIndex index(positions);
  std::vector<Cut> cuts;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    index.within(vertices[v], radius, [&](std::int32_t s, double) {
      if (segments[at(s)].a == vertex || segments[at(s)].b == vertex) return;
      const Point2 u = positions[at(s)].b - positions[at(s)].a;
      const double along = dot(vertices[v] - positions[at(s)].a, u) / squared_length(u);
      if (along > 0 && along < 1) cuts.push_back({s, along, vertex});
    });
  }
  return cuts;
}

}  // namespace

std::optional<CutSegments> cut_at_near_vertices(std::span<const Point2> vertices,
                                                std::span<const PslgSegment> segments,
                                                double radius) {
  std::vector<Cut> cuts = find_cuts(vertices, segments, radius);
  if (cuts.empty()) return std::nullopt;
  std::sort(cuts.begin(), cuts.end(), [](const Cut& c, const Cut& d) {
    return std::tie(c.segment, c.along, c.vertex) < std::tie(d.segment, d.along, d.vertex);
  });
  CutSegments result;
  std::size_t next = 0;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto add = [&](std::int32_t a, std::int32_t b) {
      result.segments.push_back({a, b, segments[s].marker});
      result.source.push_back(static_cast<std::int32_t>(s));
    };
    std::int32_t from = segments[s].a;
    for (; next < cuts.size() && at(cuts[next].segment) == s; ++next) {
      add(from, cuts[next].vertex);
      from = cuts[next].vertex;
    }
    add(from, segments[s].b);
  }
  return result;
}

}  // namespace symcell::plane
