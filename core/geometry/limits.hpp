// Coordinates that are computed with.
#pragma once

namespace symcell {

// Coordinates beyond this magnitude are refused, and nonzero extents below its inverse: squares and
// fourth powers of differences stay normal doubles, so no predicate over- or underflows.
inline constexpr double kMaxCoordinate = 1e60;

}  // namespace symcell
