// The options object: the same names, types and ranges in JSON, query strings and on the command
// line. One table in option_table.cpp defines them all.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/model.hpp"

namespace symcell {

enum class OptionScope : std::uint8_t { kAll, kPlanar, kSolids };

// One row of the table, for help texts, the API description and the command line.
struct OptionInfo {
  std::string_view name;      // as in JSON, with `_`
  std::string_view metavar;   // what stands for the value in a help text; empty: a flag
  std::string_view standard;  // the default, in words; empty: unset
  std::string_view help;      // one line, with the unit and the range
  OptionScope scope;          // models of which kind take it
  bool is_list = false;       // of values with commas between
};

[[nodiscard]] std::span<const OptionInfo> mesh_option_table();

// Options are parsed before the kind of the model may be known: options_for, below, checks whether
// they fit it. From a JSON object; unknown names are refused with kBadOption and a pointer
// "/options/<name>".
[[nodiscard]] Result<MeshOptions> options_from_json(const nlohmann::json& object);

// From texts, as in a query string or on a command line; names with `_` or `-`. A flag may have the
// empty text: it is then set. A name given twice is refused.
[[nodiscard]] Result<MeshOptions> options_from_texts(
    const std::vector<std::pair<std::string, std::string>>& texts);

// True if `name` (with `_`) is an option of meshing: lets callers separate options from other
// query parameters.
[[nodiscard]] bool is_mesh_option(std::string_view name);

// The options as a model of this kind takes them: a planar model's `center` may come as
// `axis_origin`, for example.  Errors: kBadOption and kBadAxis for what its kind has not; an option
// of the other kind at its default asks for nothing and is passed over.
[[nodiscard]] Result<MeshOptions> options_for(ModelKind kind, MeshOptions options);

// The options as used, for `settings` in the statistics; every name, null where unset or not of
// this kind. Reads back as the same options.
[[nodiscard]] nlohmann::ordered_json options_to_json(const MeshOptions& options, ModelKind kind);

}  // namespace symcell
