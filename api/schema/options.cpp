#include "api/schema/options.hpp"

#include <algorithm>
#include <set>

#include "api/nearest_name.hpp"
#include "api/printable.hpp"
#include "api/schema/option_table.hpp"

namespace symcell {
namespace {

using internal::OptionRow;
using internal::OptionValue;
using Kind = OptionValue::Kind;

const OptionRow* find_row(std::string_view name) {
  const auto rows = internal::option_rows();
  const auto row =
      std::ranges::find_if(rows, [&](const OptionRow& r) { return r.info.name == name; });
  return row == rows.end() ? nullptr : &*row;
}

Failure unknown_option(const std::string& name) {
  const std::string shown = printable(name);
  std::vector<std::string_view> names;
  for (const OptionRow& row : internal::option_rows()) names.push_back(row.info.name);
  const std::string_view best = nearest_name(shown, names);
  std::string message = "there is no option \"" + shown + "\"";
  if (!best.empty()) message += "; did you mean \"" + std::string(best) + "\"?";
  // Escaped as RFC 6901 asks.
  std::string pointer = "/options/";
  for (const char c : shown) pointer += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return fail(ErrorCode::kBadOption, std::move(message), {}, std::move(pointer));
}

OptionValue value_from_json(const nlohmann::json& json) {
  OptionValue value;
  if (json.is_boolean()) {
    value.kind = Kind::kBool;
    value.boolean = json.get<bool>();
  } else if (json.is_number()) {
    value.kind = Kind::kNumber;
    value.number = json.get<double>();
    if (json.is_number_unsigned()) value.whole = json.get<std::uint64_t>();
  } else if (json.is_string()) {
    value.kind = Kind::kText;
    value.text = json.get<std::string>();
    return value;
  } else if (json.is_array() && json.size() <= 3 &&
             std::ranges::all_of(json, [](const auto& e) { return e.is_number(); })) {
    value.kind = Kind::kNumbers;
    for (const auto& e : json) value.numbers.push_back(e.get<double>());
  } else if (!json.is_null()) {
    value.kind = Kind::kOther;
    value.text = json.is_array() ? "another list" : "an object";
    return value;
  }
  value.text = json.dump();
  return value;
}

OptionValue value_from_text(const std::string& text) {
  OptionValue value;
  value.kind = Kind::kText;
  value.from_text = true;
  value.text = text;
  return value;
}

}  // namespace

std::span<const OptionInfo> mesh_option_table() {
  static const std::vector<OptionInfo> infos = [] {
    std::vector<OptionInfo> all;
    for (const OptionRow& row : internal::option_rows()) all.push_back(row.info);
    return all;
  }();
  return infos;
}

Result<MeshOptions> options_from_json(const nlohmann::json& object) {
  MeshOptions options;
  if (object.is_null()) return options;
  if (!object.is_object()) {
    return fail(ErrorCode::kBadOption, "options must be a JSON object such as {\"min_angle\": 33}",
                {}, "/options");
  }
  for (const auto& [name, json] : object.items()) {
    const OptionRow* row = find_row(name);
    if (row == nullptr) return unknown_option(name);
    if (json.is_null()) continue;
    SYMCELL_TRY(row->set(row->info, value_from_json(json), options));
  }
  return options;
}

Result<MeshOptions> options_from_texts(
    const std::vector<std::pair<std::string, std::string>>& texts) {
  MeshOptions options;
  std::set<std::string> seen;
  for (const auto& [given, text] : texts) {
    std::string name = given;
    std::ranges::replace(name, '-', '_');
    const OptionRow* row = find_row(name);
    if (row == nullptr) return unknown_option(name);
    if (!seen.insert(name).second) {
      return fail(ErrorCode::kBadOption, name + " is given twice; give it once", {},
                  "/options/" + name);
    }
    SYMCELL_TRY(row->set(row->info, value_from_text(text), options));
  }
  return options;
}

bool is_mesh_option(std::string_view name) {
  return find_row(name) != nullptr;
}

nlohmann::ordered_json options_to_json(const MeshOptions& options, ModelKind kind) {
  const OptionScope other = is_planar(kind) ? OptionScope::kSolids : OptionScope::kPlanar;
  nlohmann::ordered_json json;
  for (const OptionRow& row : internal::option_rows()) {
    auto& value = json[std::string(row.info.name)];
    if (row.info.scope != other) value = row.get(options, kind);
  }
  return json;
}

}  // namespace symcell
