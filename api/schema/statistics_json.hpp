// Statistics and inspection as the interface's JSON documents.
#pragma once

#include <nlohmann/json.hpp>

#include "core/model/mesh_options.hpp"
#include "core/stats/statistics.hpp"
#include "core/symmetry/symmetrise.hpp"

namespace symcell {

[[nodiscard]] nlohmann::ordered_json statistics_to_json(const Statistics& statistics,
                                                        const MeshOptions& options);
[[nodiscard]] nlohmann::ordered_json inspection_to_json(const PslgInspection& inspection);

}  // namespace symcell
