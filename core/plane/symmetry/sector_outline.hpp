// One exact sector of a model that is symmetric in shape only: of each chain and its copies one
// polyline is chosen (chain_fit.hpp), junctions are averaged, and the copies are given by rotation.
//
// In contrast to close_orbits no sector gets the vertices of the others, and vertices of the input
// need not be vertices of the result. Guarantees of a success: the invariants of symmetric_pslg.hpp
// but for crossings, which the caller checks on the lifted result; chains, markers and classes of
// faces are those of the input; and no point of the input's segments is farther than the tolerance
// from the result's, nor the other way round.
#pragma once

#include "core/plane/symmetry/orbit_closure.hpp"

namespace symcell::plane {

// Of the request the link distance has no meaning.  The error told is the largest distance of both
// outlines, by points of the segments; worst_vertex is near it.
// Errors: kNotSymmetric, where sectors differ in more than places of vertices; kCancelled,
// kTimeLimit.  Cost: O(N log N).
[[nodiscard]] Result<ClosedOrbits> outline_sector(const PreparedPslg& prepared,
                                                  const SegmentIndex& index,
                                                  const ClosureRequest& request,
                                                  ExecutionContext& context);

}  // namespace symcell::plane
