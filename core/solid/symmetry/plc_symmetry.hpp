// Fold and axis of a PLC: given and checked, or detected.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/symmetry/plc_fit.hpp"

namespace symcell::solid {

// An accepted fit, with the warnings of its choice.  `ladder`, if not null: the folds that the
// numbers of vertices allow about the axis found, ascending, from 2; those beyond the tolerance with
// their errors up to ten times it.
// Errors: kBadFold, kBadAxis (options out of range), kNotSymmetric for a given fold, limits.
[[nodiscard]] Result<PlcFit> find_plc_symmetry(const PlcComplex& complex,
                                               const PlcCells& cells,
                                               const MeshOptions& options,
                                               std::vector<PlcFit>* ladder,
                                               ExecutionContext& context);

}  // namespace symcell::solid
