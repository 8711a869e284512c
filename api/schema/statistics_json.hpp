// Statistics and inspection as the interface's JSON documents.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "core/cell/statistics.hpp"
#include "core/cell/warning.hpp"
#include "core/mesh_model.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/model.hpp"

namespace symcell {

[[nodiscard]] nlohmann::ordered_json statistics_to_json(const Statistics& statistics,
                                                        const MeshOptions& options,
                                                        ModelKind kind);
// An array: code, text and mend; of near_symmetry also fold, error_rel and tolerance.
[[nodiscard]] nlohmann::ordered_json warnings_to_json(const std::vector<Warning>& warnings);
[[nodiscard]] nlohmann::ordered_json inspection_to_json(const Inspection& inspection);

}  // namespace symcell
