// Names as files give them, made fit to be names of groups.
#pragma once

#include <cctype>
#include <string>
#include <string_view>

#include "api/cad/parts.hpp"

namespace symcell::cad {

// Without blanks at its ends and without what cannot be printed; empty where a file says that there is
// none.
[[nodiscard]] inline std::string plain_name(std::string_view text) {
  constexpr std::size_t kLongest = 64;  // as long as solvers take
  std::string name;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (u < ' ' || u == 0x7f || name.size() == kLongest) continue;
    name += c;
  }
  while (!name.empty() && name.back() == ' ') name.pop_back();
  name.erase(0, name.find_first_not_of(' '));
  std::string upper = name;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper == "NONE" || upper == "UNNAMED" ? std::string() : name;
}

// One name on all faces is that of the part, or of the program that wrote the file. The order of the faces is
// that of their addresses, and must not matter.
inline void drop_name_of_all(FaceLabels& labels) {
  if (labels.IsEmpty()) return;
  const std::string first = FaceLabels::Iterator(labels).Value().name;
  for (FaceLabels::Iterator i(labels); i.More(); i.Next()) {
    if (i.Value().name != first) return;
  }
  for (FaceLabels::Iterator i(labels); i.More(); i.Next()) i.ChangeValue().name.clear();
}

}  // namespace symcell::cad
