// The pipeline of solids: symmetry, one exact sector, initial tetrahedralization, quotient, refine,
// improve, cell, statistics. The full mesh is streamed from the result by FullMeshView.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/mesh_outcome.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/sector/sector_source.hpp"
#include "core/solid/tuning.hpp"

namespace symcell::solid {

// `source`: the model made symmetric (symmetrise_plc or symmetrise_surface).
// Errors: all meshing and limit codes.  Same input and options: same bytes.
[[nodiscard]] Result<MeshOutcome> mesh_solid(const SectorSource& source,
                                             const MeshOptions& options,
                                             ExecutionContext& context,
                                             const Tuning& tuning = {});

}  // namespace symcell::solid
