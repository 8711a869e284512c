// How far an outline goes from another: the largest distance of its points, not of its vertices
// only, from the nearest of the other's segments.
#pragma once

#include "core/geometry/segment_index.hpp"

namespace symcell {

// Largest distance of a point of the segment ab from what `index` holds, exact to within
// `resolution` (a length, > 0).  Infinity if `index` is empty.
// Cost: O(log N) but where the nearest segment changes, a few times more.
[[nodiscard]] double outline_distance(const SegmentIndex& index,
                                      Point2 a,
                                      Point2 b,
                                      double resolution);

}  // namespace symcell
