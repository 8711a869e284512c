// One entry for models of every kind.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/inspection.hpp"
#include "core/cell/mesh_outcome.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/model.hpp"

namespace symcell {

// Makes the model symmetric and meshes it, in the wing of its kind.  Errors: all model, meshing and
// limit codes; kStrictWarnings.
[[nodiscard]] Result<MeshOutcome> mesh_model(const Model& model,
                                             const MeshOptions& options,
                                             ExecutionContext& context);

// `symcell inspect`: validates the model and reports what symmetrising would find; meshes nothing.
// Errors: model codes, limits, kStrictWarnings.
[[nodiscard]] Result<Inspection> inspect_model(const Model& model,
                                               const MeshOptions& options,
                                               ExecutionContext& context);

}  // namespace symcell
