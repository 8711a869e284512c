// One entry for models of every kind.
#pragma once

#include <variant>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/model.hpp"
#include "core/plane/mesh_pslg.hpp"
#include "core/plane/symmetry/symmetrise.hpp"
#include "core/solid/sector/symmetrise.hpp"

namespace symcell {

// Planar models go to mesh_pslg, solids to mesh_solid.  Errors: all model, meshing and limit codes.
[[nodiscard]] Result<MeshOutcome> mesh_model(const Model& model,
                                             const MeshOptions& options,
                                             ExecutionContext& context);

// `symcell inspect`: validates the model and tells what symmetrising would find; meshes nothing.
// Errors: model codes, limits.
[[nodiscard]] Result<Inspection> inspect_model(const Model& model,
                                               const MeshOptions& options,
                                               ExecutionContext& context);

}  // namespace symcell
