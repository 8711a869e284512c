#include "server/http/header_values.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace symcell::server {
namespace {

std::string_view trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(trim(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

double weight_of(const std::vector<std::string_view>& parameters) {
  for (std::size_t i = 1; i < parameters.size(); ++i) {
    const std::string parameter = lower(parameters[i]);
    if (!parameter.starts_with("q=")) continue;
    double weight = 0;
    const char* end = parameter.data() + parameter.size();
    const auto parsed = std::from_chars(parameter.data() + 2, end, weight);
    if (parsed.ec != std::errc() || !(weight >= 0)) return 0;
    return std::min(weight, 1.0);
  }
  return 1;
}

}  // namespace

std::string media_type_of(std::string_view content_type) {
  return lower(split(content_type, ';').front());
}

std::vector<WeightedValue> parse_weighted_list(std::string_view text) {
  std::vector<WeightedValue> values;
  for (const std::string_view entry : split(text, ',')) {
    const auto parts = split(entry, ';');
    if (!parts.front().empty()) values.push_back({lower(parts.front()), weight_of(parts)});
  }
  return values;
}

bool accepts_media_type(std::string_view accept, std::string_view media_type) {
  const auto values = parse_weighted_list(accept);
  if (values.empty()) return true;
  const std::string group = std::string(media_type.substr(0, media_type.find('/'))) + "/*";
  // The most specific range decides.
  for (const std::string_view wanted :
       {media_type, std::string_view(group), std::string_view("*/*")}) {
    const auto found = std::ranges::find(values, wanted, &WeightedValue::value);
    if (found != values.end()) return found->weight > 0;
  }
  return false;
}

std::optional<std::int64_t> prefer_wait_seconds(std::string_view prefer) {
  for (const std::string_view entry : split(prefer, ',')) {
    for (const std::string_view preference : split(entry, ';')) {
      const std::string text = lower(preference);
      const std::size_t equals = text.find('=');
      if (equals == std::string::npos || trim(text.substr(0, equals)) != "wait") continue;
      return parse_whole_number(trim(std::string_view(text).substr(equals + 1)));
    }
  }
  return std::nullopt;
}

bool etag_matches(std::string_view if_none_match, std::string_view etag) {
  for (std::string_view entry : split(if_none_match, ',')) {
    if (entry.starts_with("W/")) entry.remove_prefix(2);
    if (entry == "*" || entry == etag) return true;
  }
  return false;
}

RangeRequest parse_byte_range(std::string_view text, std::uint64_t bytes) {
  constexpr std::string_view kUnit = "bytes=";
  if (lower(text.substr(0, kUnit.size())) != kUnit || text.find(',') != std::string_view::npos)
    return {};
  text = trim(text.substr(kUnit.size()));
  const std::size_t dash = text.find('-');
  if (dash == std::string_view::npos) return {};
  const auto first = parse_whole_number(text.substr(0, dash));
  const auto last = parse_whole_number(text.substr(dash + 1));
  if (dash == 0) {
    // The last so many bytes.
    if (!last) return {};
    if (*last == 0 || bytes == 0) return {.unsatisfiable = true};
    const auto wanted = std::min(static_cast<std::uint64_t>(*last), bytes);
    return {.range = ByteRange{bytes - wanted, bytes - 1}};
  }
  if (!first || (dash + 1 < text.size() && !last) || (last && *last < *first)) return {};
  const auto begin = static_cast<std::uint64_t>(*first);
  if (begin >= bytes) return {.unsatisfiable = true};
  const std::uint64_t end =
      last ? std::min(static_cast<std::uint64_t>(*last), bytes - 1) : bytes - 1;
  return {.range = ByteRange{begin, end}};
}

std::optional<std::int64_t> parse_whole_number(std::string_view text) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (text.empty() || parsed.ec != std::errc() || parsed.ptr != end || value < 0) {
    return std::nullopt;
  }
  return value;
}

}  // namespace symcell::server
