// The mark that some editors put before texts in UTF-8. It means nothing there (RFC 8259, 8.1, of JSON).
#pragma once

#include <string_view>

namespace symcell {

[[nodiscard]] inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

}  // namespace symcell
