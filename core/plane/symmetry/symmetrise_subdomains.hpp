// symmetrise on faces that are known already, with the ladder of folds it looked at.
#pragma once

#include <vector>

#include "core/plane/input/subdomains.hpp"
#include "core/plane/symmetry/fold_detection.hpp"
#include "core/plane/symmetry/symmetrise.hpp"

namespace symcell::plane {

// `ladder`: filled if not null and the fold is to be detected.  Otherwise as symmetrise.
[[nodiscard]] Result<SymmetricPslg> symmetrise_subdomains(const Pslg& pslg,
                                                          const Subdomains& subdomains,
                                                          const MeshOptions& options,
                                                          std::vector<FoldFit>* ladder,
                                                          ExecutionContext& context);

}  // namespace symcell::plane
