// Segments that a vertex touches but for rounding, cut at that vertex.
//
// A vertex computed to lie on a segment lies beside it by a rounding error: on one side it leaves a
// gap, on the other it makes the segments that end there cross. Both mean "the vertex is on the
// segment".
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/model/pslg.hpp"

namespace symcell::plane {

struct CutSegments {
  std::vector<PslgSegment> segments;
  std::vector<std::int32_t> source;  // per segment: the one it is part of
};

// Nothing if no vertex lies within `radius` of a segment it does not end.
// Requires: indices in range, no segment of length zero.  Cost: O(N log N + K).
[[nodiscard]] std::optional<CutSegments> cut_at_near_vertices(std::span<const Point2> vertices,
                                                              std::span<const PslgSegment> segments,
                                                              double radius);

}  // namespace symcell::plane
