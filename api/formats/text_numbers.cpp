#include "api/formats/text_numbers.hpp"

#include <charconv>
#include <cmath>

namespace symcell {
namespace {

std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  return token;
}

// from_chars reports overflow and underflow by the same code. The decimal exponent decides: of
// numbers out of range, those with a value below 1 are tiny.
bool is_tiny(std::string_view token) {
  if (token.starts_with('-')) token.remove_prefix(1);
  const std::size_t mantissa_end = token.find_first_of("eE");
  const std::string_view mantissa = token.substr(0, mantissa_end);
  double exponent = 0;
  if (mantissa_end != std::string_view::npos) {
    const std::string_view text = without_plus(token.substr(mantissa_end + 1));
    std::int64_t parsed = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
    if (error != std::errc{}) return text.starts_with('-');
    exponent = static_cast<double>(parsed);
  }
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t digit = mantissa.find_first_of("123456789");
  if (digit == std::string_view::npos) return true;
  exponent +=
      digit < point ? static_cast<double>(point - digit) - 1 : -static_cast<double>(digit - point);
  return exponent < 0;
}

}  // namespace

ParsedNumber parse_number(std::string_view token) {
  token = without_plus(token);
  double value = 0;
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument || token.empty()) return {};
  if (error == std::errc::result_out_of_range) {
    return is_tiny(token) ? ParsedNumber{NumberKind::kFinite, 0.0}
                          : ParsedNumber{NumberKind::kNonFinite, HUGE_VAL};
  }
  return {std::isfinite(value) ? NumberKind::kFinite : NumberKind::kNonFinite, value};
}

std::optional<std::int64_t> parse_integer(std::string_view token) {
  token = without_plus(token);
  std::int64_t value = 0;
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (stop != end || error != std::errc{}) return std::nullopt;
  return value;
}

std::optional<std::int32_t> whole_int32(double value) {
  if (!(value >= -2147483648.0 && value <= 2147483647.0) || std::floor(value) != value) {
    return std::nullopt;
  }
  return static_cast<std::int32_t>(value);
}

}  // namespace symcell
