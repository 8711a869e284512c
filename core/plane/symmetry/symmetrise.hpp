// From a validated PSLG and the user's fold, centre and tolerance to an exactly symmetric PSLG.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/inspection.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

// Detects (or checks the declared) fold and centre and averages every orbit.
// Requires: validate_pslg(pslg) passed.
// Errors: kBadFold, kBadAxis, kNotSymmetric (names fold, error found, tolerance and worst vertex),
// kDegenerateGeometry, kCancelled, kTimeLimit.  Cost: O(N log N) a candidate fold.
[[nodiscard]] Result<SymmetricPslg> symmetrise(const Pslg& pslg,
                                               const MeshOptions& options,
                                               ExecutionContext& context);

// `symcell inspect`: what symmetrise would find, without meshing.  Same errors as symmetrise.
[[nodiscard]] Result<PslgInspection> inspect_pslg(const Pslg& pslg,
                                                  const MeshOptions& options,
                                                  ExecutionContext& context);

}  // namespace symcell::plane
