// The options object: the same names, types and ranges in JSON, query strings and on the command
// line. One table in options.cpp defines them all.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/model/mesh_options.hpp"

namespace symcell {

// One row of the table, for help texts, the API description and the command line.
struct OptionInfo {
  std::string_view name;      // as in JSON, with `_`
  std::string_view metavar;   // what stands for the value in a help text; empty: a flag
  std::string_view standard;  // the default, in words; empty: unset
  std::string_view help;      // one line, with the unit and the range
  bool solids_only;           // known, but refused for planar models
};

[[nodiscard]] std::span<const OptionInfo> mesh_option_table();

// From a JSON object; unknown names are refused with kBadOption and a pointer "/options/<name>".
[[nodiscard]] Result<MeshOptions> options_from_json(const nlohmann::json& object);

// From texts, as in a query string or on a command line; names with `_` or `-`. A flag may have the
// empty text: it is then set. A name given twice is refused.
[[nodiscard]] Result<MeshOptions> options_from_texts(
    const std::vector<std::pair<std::string, std::string>>& texts);

// True if `name` (with `_`) is an option of meshing: lets callers tell options from other
// query parameters.
[[nodiscard]] bool is_mesh_option(std::string_view name);

// The options as used, for `settings` in the statistics; every name, null where unset.
[[nodiscard]] nlohmann::ordered_json options_to_json(const MeshOptions& options);

}  // namespace symcell
