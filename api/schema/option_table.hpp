// The one table of meshing options: name, help, how a value is checked, set and written.
// Internal to api/schema; callers use options.hpp.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/schema/options.hpp"

namespace symcell::internal {

// A value as given, from JSON or from text, before its option's type is known.
struct OptionValue {
  enum class Kind : std::uint8_t { kNull, kBool, kNumber, kText, kNumbers, kOther };
  Kind kind = Kind::kNull;
  bool from_text = false;  // a text may still be meant as any kind
  bool boolean = false;
  double number = 0;
  std::optional<std::uint64_t> whole;  // exact, if the number is one that fits
  std::vector<double> numbers;         // kNumbers
  std::string text;                    // kText; otherwise the value as shown in messages
};

struct OptionRow {
  OptionInfo info;
  // Null has been dealt with: it leaves the default.  Errors: kBadOption, kBadFold, kBadAxis.
  Result<void> (*set)(const OptionInfo& info, const OptionValue& value, MeshOptions& options);
  nlohmann::ordered_json (*get)(const MeshOptions& options, ModelKind kind);
};

[[nodiscard]] std::span<const OptionRow> option_rows();

}  // namespace symcell::internal
