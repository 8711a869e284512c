// The planar pipeline: initial triangulation, quotient, refine, improve, cell, statistics. The full
// mesh is streamed from the result by FullMeshView.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/mesh_outcome.hpp"
#include "core/model/mesh_options.hpp"
#include "core/plane/refine/local_sizes.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

// `symmetric`: the model made symmetric (symmetrise); `sizes`: what options.sizes means on it.
// Errors: all meshing and limit codes.  Same input and options: same bytes.
[[nodiscard]] Result<MeshOutcome> mesh_pslg(const SymmetricPslg& symmetric,
                                            const MeshOptions& options,
                                            const LocalSizes& sizes,
                                            ExecutionContext& context);

}  // namespace symcell::plane
