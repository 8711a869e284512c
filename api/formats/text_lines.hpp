// Line by line, token by token, over text formats that have `#` comments.
#pragma once

#include <cstddef>
#include <string_view>

namespace symcell {

class TextLines {
 public:
  explicit TextLines(std::string_view bytes) : rest_(bytes) {}

  // Goes to the next line that holds a token, comments taken off; false at the end of the text.
  bool next_line();

  // The next token of the line; empty where it has no more.
  [[nodiscard]] std::string_view next_token();

  // The same, but on to further lines; empty at the end of the text.
  [[nodiscard]] std::string_view next_token_anywhere();

  // What is left of the line; blanks at its end included.
  [[nodiscard]] std::string_view rest() const { return line_; }

  [[nodiscard]] std::size_t number() const { return number_; }  // of the line, from 1
  [[nodiscard]] std::size_t bytes_left() const { return line_.size() + rest_.size(); }

 private:
  std::string_view rest_;  // the lines to come
  std::string_view line_;  // what is left of this one
  std::size_t number_ = 0;
};

}  // namespace symcell
