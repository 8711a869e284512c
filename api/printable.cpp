#include "api/printable.hpp"

namespace symcell {

std::string printable(std::string_view text, std::size_t limit) {
  std::string shown;
  for (const char c : text.substr(0, limit)) shown += c >= ' ' && c <= '~' ? c : '?';
  if (text.size() > limit) shown += "...";
  return shown;
}

}  // namespace symcell
