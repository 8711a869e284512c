// What the fuzz targets share.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/base/error.hpp"

namespace symcell::fuzz {

[[nodiscard]] inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// A law that every input must keep.
inline void require(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", law);
  std::abort();
}

// Parsers may refuse anything, but they say why, in one printable line.
inline void require_good_message(const Error& error) {
  require(error.code != ErrorCode::kInternal, "no input is an internal error");
  require(!error.message.empty(), "an error has a message");
  for (const char c : error.message) require(c >= ' ' && c <= '~', "messages are printable ASCII");
}

// Writes the model to the file that SYMCELL_FUZZ_MODEL names, to look at it with other programs.
template <class Write>
void keep_model(Write write) {
  const char* path = std::getenv("SYMCELL_FUZZ_MODEL");
  if (path == nullptr) return;
  const std::string text = write();
  std::FILE* file = std::fopen(path, "w");
  require(file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size() &&
              std::fclose(file) == 0,
          "the model's file can be written");
}

}  // namespace symcell::fuzz
