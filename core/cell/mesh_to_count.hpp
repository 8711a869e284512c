// The option `elements`: the longest edge for all that gives a cell of so many elements.
#pragma once

#include <functional>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/mesh_outcome.hpp"
#include "core/model/mesh_options.hpp"

namespace symcell {

// `mesh`: meshes with these options, of which max_edge is varied and never above the one given.
// Takes the first mesh with a count within 10 %, or, told by a warning, the nearest of those made: a model
// without any bound may have more elements already.
// Errors: those of `mesh`.
[[nodiscard]] Result<MeshOutcome> mesh_to_count(
    const std::function<Result<MeshOutcome>(const MeshOptions&)>& mesh,
    const MeshOptions& options,
    ExecutionContext& context);

}  // namespace symcell
