#include "api/formats/text_lines.hpp"

#include <algorithm>

namespace symcell {
namespace {

constexpr std::string_view kBlank = " \t\r\v\f,";

}  // namespace

bool TextLines::next_line() {
  line_ = {};
  while (!rest_.empty() && line_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    text = text.substr(0, text.find('#'));
    line_ = text.substr(std::min(text.find_first_not_of(kBlank), text.size()));
  }
  return !line_.empty();
}

std::string_view TextLines::next_token() {
  const std::size_t end = std::min(line_.find_first_of(kBlank), line_.size());
  const std::string_view token = line_.substr(0, end);
  line_.remove_prefix(end);
  line_.remove_prefix(std::min(line_.find_first_not_of(kBlank), line_.size()));
  return token;
}

std::string_view TextLines::next_token_anywhere() {
  if (line_.empty() && !next_line()) return {};
  return next_token();
}

}  // namespace symcell
