// Vertices put on the segments of a symmetric PSLG, at all copies.
#pragma once

#include <cstddef>
#include <span>

#include "core/base/error.hpp"
#include "core/geometry/rotation.hpp"
#include "core/model/mesh_options.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

// Puts new vertices on a segment, or the arc that it is a chord of. The first part takes the place of
// the segment, the others follow behind all segments.  `shares`: of the length from a, in (0, 1),
// ascending.
void split_segment(SymmetricPslg& pslg,
                   const RotationTable& rotations,
                   std::size_t segment,
                   std::span<const double> shares);

// Relative to the centre.  `rotations`: of the PSLG's fold.
[[nodiscard]] Point2 place_of(const SymmetricPslg& pslg,
                              const RotationTable& rotations,
                              OrbitVertex v);

// Divides the segments of each marker into equal parts, on which refinement puts no more vertices.
// Errors: kBadOption: a marker that no segment has, or one of arcs, whose chords follow chord_error.
[[nodiscard]] Result<void> divide_segments(SymmetricPslg& pslg,
                                           const std::vector<DivisionRequest>& divisions);

}  // namespace symcell::plane
