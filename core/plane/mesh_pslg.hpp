// The planar pipeline: initial triangulation, quotient, refine, improve, cell, statistics. The full
// mesh is streamed from the result by FullMeshView.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/mesh_outcome.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

// `symmetric`: `model` made symmetric (symmetrise).
// Errors: all meshing and limit codes.  Same input and options: same bytes.
[[nodiscard]] Result<MeshOutcome> mesh_pslg(const Pslg& model,
                                            const SymmetricPslg& symmetric,
                                            const MeshOptions& options,
                                            ExecutionContext& context);

}  // namespace symcell::plane
