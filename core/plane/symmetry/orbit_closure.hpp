// One fold and centre tried in earnest: orbits of vertices, the copies that the shape has but the
// vertices lack, orbits of segments, averages.
//
// Guarantees of a success: the invariants of symmetric_pslg.hpp, but for crossings that averaging
// may cause, which the caller checks on the lifted result.
#pragma once

#include <string>

#include "core/base/execution_context.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/plane/symmetry/prepared_pslg.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

struct ClosureRequest {
  std::int32_t fold = 1;
  Point2 centre;
  double link = 0;       // positions this near after rotation are copies of each other
  double tolerance = 0;  // largest move allowed; both in input units
  bool may_add = true;   // copies that the shape has and the vertices lack
};

struct ClosedOrbits {
  SymmetricPslg pslg;
  // Labels of the faces beside copy k of segment s, seen from a to b, at s * fold + k.
  struct Sides {
    std::int32_t left = kNotMeshed;
    std::int32_t right = kNotMeshed;
  };
  std::vector<Sides> sides;
  Point2 centre_shift;             // where the vertices would rather have the centre
  std::int32_t worst_vertex = -1;  // point of the prepared PSLG that was moved most
};

// Without seeds, diameter and the detection flags; symmetry_error_rel is relative to the diameter.
// Errors: kNotSymmetric (names what has no copy), kTooLarge, kCancelled, kTimeLimit.
// Cost: O(N log N + n * orbits that lack copies).
[[nodiscard]] Result<ClosedOrbits> close_orbits(const PreparedPslg& prepared,
                                                const SegmentIndex& index,
                                                const ClosureRequest& request,
                                                ExecutionContext& context);

}  // namespace symcell::plane
