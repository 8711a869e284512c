// Foreign text as messages may show it: short, one line, plain ASCII.
#pragma once

#include <string>
#include <string_view>

namespace symcell {

// At most `limit` bytes of `text`, "..." if it was longer; bytes that are no printable ASCII
// become '?', so that any message can stand in JSON and on a terminal.
[[nodiscard]] std::string printable(std::string_view text, std::size_t limit = 40);

}  // namespace symcell
