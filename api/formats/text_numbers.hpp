// Numbers in text files, by from_chars: exact, fast, deaf to the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace symcell {

enum class NumberKind : std::uint8_t { kFinite, kNonFinite, kNoNumber };

struct ParsedNumber {
  NumberKind kind = NumberKind::kNoNumber;
  double value = 0;
};

// The whole token as a number; a leading '+' is allowed. Overflow, "inf" and "nan" are kNonFinite;
// what underflows is 0.
[[nodiscard]] ParsedNumber parse_number(std::string_view token);

// The whole token as an integer; nullopt if it is none or does not fit.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view token);

// `value` as a whole number of 32 bits: 2.0 is 2; nullopt for 2.5, NaN, 3e9.
[[nodiscard]] std::optional<std::int32_t> whole_int32(double value);

}  // namespace symcell
