// The axis and fold of a shape, found or checked.
//
// Per axis, a ladder of folds with errors. "The largest fold within the tolerance" would be wrong:
// a fine polygon passes every fold for a circle. A fold is dropped if another one, neither dividing
// the other, has less than a quarter of its error, or if its error is far above those of its own
// divisors; the largest left counts. A shape that any angle fits is a surface of revolution: which
// fold is meant must then be given. So is one that is coarsely divided: nothing fits within the
// tolerance and stands out, and every angle fits within twice as much.
//
// Folds up to ten tolerances are measured beside it, and those reported that a larger tolerance
// would take by the same rules.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/inspection.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/surface/clean_surface.hpp"
#include "core/solid/symmetry/solid_symmetry.hpp"

namespace symcell::solid {

struct DetectedSymmetry {
  Symmetry symmetry;
  std::vector<FoldCandidate> folds;  // about the axis, ascending, up to ten tolerances
};

// Requires: `clean` has no problem.
// Errors: kBadFold, kBadAxis, kNotSymmetric, kAmbiguousSymmetry, limits.
[[nodiscard]] Result<DetectedSymmetry> detect_surface_symmetry(const CleanSurface& clean,
                                                               const MeshOptions& options,
                                                               ExecutionContext& context);

}  // namespace symcell::solid
