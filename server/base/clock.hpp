// Wall-clock times as milliseconds since 1970, UTC, and their text form; and a clock for durations.
#pragma once

#include <cstdint>
#include <string>

namespace symcell::server {

[[nodiscard]] std::int64_t now_ms();
// Never set, never goes back; means nothing beyond this process.
[[nodiscard]] std::int64_t steady_ms();

// RFC 3339 with milliseconds: "2024-05-01T12:00:00.123Z".
[[nodiscard]] std::string format_timestamp(std::int64_t ms);

// As HTTP wants it: "Wed, 01 May 2024 12:00:00 GMT".
[[nodiscard]] std::string format_http_date(std::int64_t ms);

}  // namespace symcell::server
