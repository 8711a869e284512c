// One fold and centre made exact, in the way that suits the model: vertices that are images of each
// other are averaged; where the shape is symmetric only, one sector's outline is chosen.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"
#include "core/plane/symmetry/prepared_pslg.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

struct FoldRequest {
  std::int32_t fold = 1;
  Point2 centre;
  double tolerance = 0;  // input units
};

// Guarantees of a success: all invariants of symmetric_pslg.hpp, and the faces that were meant.
// Errors: kNotSymmetric, kTooLarge, kCancelled, kTimeLimit.  Cost: O(N log N).
[[nodiscard]] Result<SymmetricPslg> close_fold(const Pslg& pslg,
                                               const MeshOptions& options,
                                               const PreparedPslg& prepared,
                                               const SegmentIndex& index,
                                               const FoldRequest& request,
                                               ExecutionContext& context);

}  // namespace symcell::plane
