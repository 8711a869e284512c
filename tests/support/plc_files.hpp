// PLC JSON for tests of core, which must not depend on the readers.
#pragma once

#include <filesystem>

#include "core/model/plc.hpp"

namespace symcell::test {

// Throws what nlohmann::json throws on bad files.
[[nodiscard]] Plc read_plc_json(const std::filesystem::path& path);

}  // namespace symcell::test
