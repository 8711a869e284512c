// gzip'd input: unpacked with a bound on the result, so that a small file cannot fill the memory.
#pragma once

#include <string>
#include <string_view>

#include "core/base/error.hpp"

namespace symcell {

[[nodiscard]] bool is_gzip(std::string_view bytes);

// All members of a gzip file, one after the other.
// Errors: kTooLarge (more than `max_bytes`), kTruncated, kSyntax (damaged).
[[nodiscard]] Result<std::string> gunzip(std::string_view bytes, std::size_t max_bytes);

}  // namespace symcell
