// Values of HTTP headers and query parameters, taken apart.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace symcell::server {

// "text/plain; charset=utf-8" -> "text/plain", lower case.
[[nodiscard]] std::string media_type_of(std::string_view content_type);

struct WeightedValue {
  std::string value;  // lower case, parameters dropped
  double weight = 1;  // of q=, 0 to 1
};

// A list as in Accept or Accept-Encoding.
[[nodiscard]] std::vector<WeightedValue> parse_weighted_list(std::string_view text);

// True if an Accept header takes `media_type`; an empty header takes everything.
[[nodiscard]] bool accepts_media_type(std::string_view accept, std::string_view media_type);

// Seconds of "wait=" in a Prefer header.
[[nodiscard]] std::optional<std::int64_t> prefer_wait_seconds(std::string_view prefer);

// True if If-None-Match names `etag` (quotes included) or is "*"; W/ is ignored, as the standard
// asks for here.
[[nodiscard]] bool etag_matches(std::string_view if_none_match, std::string_view etag);

struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;  // included
};
struct RangeRequest {
  std::optional<ByteRange> range = {};  // nullopt: all
  bool unsatisfiable = false;
};

// Of a Range header and a body of so many bytes. Several ranges at once, other units and what is
// malformed count as no range, as the standard allows.
[[nodiscard]] RangeRequest parse_byte_range(std::string_view text, std::uint64_t bytes);

// Digits only.
[[nodiscard]] std::optional<std::int64_t> parse_whole_number(std::string_view text);

}  // namespace symcell::server
