// What a PSLG must hold before anything is computed from it.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/pslg.hpp"

namespace symcell::plane {

// Checks, in this order: size, finite coordinates and seeds, range, segment indices, zero-length
// segments, duplicate vertices (nearer than resolution_of), all collinear, overlapping and crossing
// segments and vertices inside segments (exact), seeds (each hole and region seed inside a bounded
// face of the PSLG, none on a segment, no face with both a hole and a region seed or two regions
// that differ), contours that all but close and would be left out.  The first failure is returned with the ids at fault and a JSON pointer.
// A vertex in the interior of a segment is allowed: symmetrise cuts the segment there. So is one
// that lies beside the segment by a rounding error (1e-12 of the diameter), even if segments that
// end there cross it: no computed coordinates could do better.  A segment repeated with the same
// marker counts once.
// Cost: O((N + K) log N) for K bounding-box overlaps.
[[nodiscard]] Result<void> validate_pslg(const Pslg& pslg, ExecutionContext& context);

// The first of these checks, which look at every vertex, seed and segment for itself: size, finite
// coordinates, range, segment indices, zero-length segments.
[[nodiscard]] Result<void> check_entities(const Pslg& pslg);

}  // namespace symcell::plane
