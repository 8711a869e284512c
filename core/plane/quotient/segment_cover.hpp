// What a planar mesh covers of its domain: the same before and after refinement. With triangles
// that are all positive, subsegments that make up each segment once and an area that is kept, the
// mesh fills the domain once and nothing else.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/plane/quotient/quotient_triangulation.hpp"

namespace symcell::plane {

struct SegmentCover {
  struct Segment {
    double one_sided = 0;  // length of subsegments with the domain on one side
    double two_sided = 0;  // on both
  };
  std::vector<Segment> segments;  // per orbit of segments
  double area = 0;                // of the quotient
  std::int64_t euler = 0;         // vertices - edges + triangles, of the whole
};

// Cost: O(triangles).
[[nodiscard]] SegmentCover measure_segment_cover(const QuotientTriangulation& mesh);

// Errors: kInternal, naming the segment.
[[nodiscard]] Result<void> compare_segment_covers(const SegmentCover& wanted,
                                                  const SegmentCover& found);

}  // namespace symcell::plane
