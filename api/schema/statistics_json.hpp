// Statistics and inspection as the interface's JSON documents.
#pragma once

#include <nlohmann/json.hpp>

#include "core/cell/statistics.hpp"
#include "core/mesh_model.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/model.hpp"

namespace symcell {

[[nodiscard]] nlohmann::ordered_json statistics_to_json(const Statistics& statistics,
                                                        const MeshOptions& options,
                                                        ModelKind kind);
[[nodiscard]] nlohmann::ordered_json inspection_to_json(const Inspection& inspection);

}  // namespace symcell
