// The whole surface of which a closed one bounds one of n equal sectors.
#pragma once

#include <cstdint>

#include "core/base/error.hpp"
#include "core/geometry/axis_frame.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell::solid {

// The sector and its copies, turned about the axis. The faces on which neighbours touch, plane or not,
// are the sector's two cuts: they are left out, and their rims joined where corners stand opposite each
// other within the tolerance. What is left open between them is for the mending of surfaces to close.
// `sector`: closed and oriented.  `tolerance`: input units, by which the cuts may differ.
// Errors: kBadFold (fewer than 2 sectors), kNotSymmetric (no two faces meet, or one is larger than
// the other), kTooLarge.  Cost: O(nN + N log N).
[[nodiscard]] Result<TriangleSurface> make_whole(const IndexedSurface& sector,
                                                 std::int32_t sectors,
                                                 const AxisFrame& axis,
                                                 double tolerance);

}  // namespace symcell::solid
