// The planar pipeline: validate, symmetrise, initial triangulation, quotient, refine, improve,
// cell, statistics. The full mesh is streamed from the result by FullMeshView.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cells/symmetry_cell_mesh.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"
#include "core/stats/statistics.hpp"

namespace symcell {

struct MeshOutcome {
  SymmetryCellMesh mesh;
  Statistics statistics;
};

// Errors: all model, meshing and limit codes.  Same input and options: same bytes.
[[nodiscard]] Result<MeshOutcome> mesh_pslg(const Pslg& pslg,
                                            const MeshOptions& options,
                                            ExecutionContext& context);

}  // namespace symcell
