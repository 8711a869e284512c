// What the fuzz targets share.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/model/pslg.hpp"

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

// Of readers of drawings, which number their vertices themselves.
inline void require_good_drawing(const Result<Pslg>& model) {
  if (!model) return require_good_message(model.error());
  require(model->bulges.empty() || model->bulges.size() == model->segments.size(),
          "a bulge a segment");
  const auto count = static_cast<std::int32_t>(model->vertices.size());
  for (const PslgSegment& s : model->segments) {
    require(s.a >= 0 && s.b >= 0 && s.a < count && s.b < count, "segments join vertices");
  }
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
