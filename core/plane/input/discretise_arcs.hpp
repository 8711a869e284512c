// Arcs of a PSLG as chords, in phase with its symmetry.
//
// Equal arcs get equal chords, so that copies of an arc have copies of its chords. What would break
// that is where a drawing happens to begin an arc: arcs of one circle that go on from one another
// are one, and are cut where other segments meet them. A whole circle has no such place: about the
// centre of the symmetry it is cut at a multiple of the fold, elsewhere in equal parts from where it
// is farthest from the centre. Joints that the symmetry permutes stay vertices.
//
// The fold for this is found on the curves: it permutes the ends and middles of arcs, the corners,
// and the centres of circles. It only places vertices; `symmetrise` has the word on the symmetry.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"

namespace symcell::plane {

// Straight segments; those that are chords of arcs have the arcs' bulges. Vertices and segments of
// the model keep their numbers, but for joints within arcs, whose numbers chords take over.
struct ChordedPslg {
  Pslg pslg;
  std::vector<std::int32_t> source;  // per segment: that of the model
};

// Chords turn by as little as `chord_error_rel` and `max_edge` ask for; where chords of arcs that
// lie close would cross, by half of that, and so on.
// Errors: as validate_pslg, which the result has passed; segments are named by the model's numbers.
// kDegenerateGeometry of an arc that is no circle's part, kTooLarge of more than kMaxPslgVertices.
// Requires: pslg.has_arcs().  Cost: O(N log N) a round.
[[nodiscard]] Result<ChordedPslg> discretise_arcs(const Pslg& pslg,
                                                  const MeshOptions& options,
                                                  ExecutionContext& context);

}  // namespace symcell::plane
