#include "api/formats/off.hpp"

#include <string>
#include <utility>
#include <vector>

#include "api/formats/surface_reading.hpp"
#include "api/formats/text_lines.hpp"
#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell {
namespace {

std::string quoted(std::string_view token) {
  return "\"" + printable(token) + "\"";
}

class OffReader {
 public:
  explicit OffReader(std::string_view bytes) : lines_(bytes) {}

  Result<TriangleSurface> read() {
    auto done = read_header();
    if (done) done = read_vertices();
    if (done) done = read_faces();
    if (done && lines_.next_line()) {
      done = complain(ErrorCode::kCountMismatch,
                      "the file goes on after its last face; are the counts right?");
    }
    if (!done) return error_of(done);
    return internal::finished(std::move(surface_), "OFF");
  }

 private:
  [[nodiscard]] std::string place() const {
    return "line " + std::to_string(lines_.number()) + ": ";
  }
  [[nodiscard]] Failure complain(ErrorCode code,
                                 const std::string& what,
                                 std::string pointer = {}) const {
    return fail(code, place() + what, {}, std::move(pointer));
  }

  // Believed only as far as the bytes left can bear it.
  [[nodiscard]] Result<std::size_t> as_count(std::string_view token,
                                             const std::string& what) const {
    const std::optional<std::int64_t> count = parse_integer(token);
    if (!count || *count < 0) {
      return complain(ErrorCode::kSyntax, quoted(token) + " is no number of " + what);
    }
    const auto most = static_cast<std::int64_t>(lines_.bytes_left() / 2 + 1);
    if (*count <= most) return static_cast<std::size_t>(*count);
    return complain(ErrorCode::kCountMismatch, "here should follow " + std::to_string(*count) +
                                                   " " + what + ", but at most " +
                                                   std::to_string(most) + " can");
  }

  // [keyword] vertices faces [edges], on one line or two.
  Result<void> read_header() {
    if (!lines_.next_line()) return complain(ErrorCode::kTruncated, "the file has no header");
    std::string_view token = lines_.next_token();
    if (is_off_keyword(token)) {
      if (token.find('4') != std::string_view::npos || token.find('n') != std::string_view::npos) {
        return complain(ErrorCode::kUnsupportedModel, quoted(token) + " has not three dimensions");
      }
      token = lines_.next_token();
      if (token == "BINARY") {
        return complain(ErrorCode::kUnsupportedModel, "binary OFF is not read; write it as text");
      }
      if (token.empty()) {
        if (!lines_.next_line()) {
          return complain(ErrorCode::kTruncated, "the file ends before its counts");
        }
        token = lines_.next_token();
      }
    }
    const auto vertices = as_count(token, "vertices");
    if (!vertices) return error_of(vertices);
    const auto faces = as_count(lines_.next_token(), "faces");
    if (!faces) return error_of(faces);
    vertices_ = *vertices;
    faces_ = *faces;
    return {};
  }

  Result<void> next_entry(const char* what, std::size_t i, std::size_t count) {
    if (lines_.next_line()) return {};
    return complain(ErrorCode::kTruncated, std::string("the file ends where ") + what + " " +
                                               std::to_string(i) + " of " + std::to_string(count) +
                                               " should stand");
  }

  Result<void> read_vertices() {
    for (std::size_t i = 0; i < vertices_; ++i) {
      SYMCELL_TRY(next_entry("vertex", i, vertices_));
      double values[3] = {};
      for (double& value : values) {
        const std::string_view token = lines_.next_token();
        const ParsedNumber number = parse_number(token);
        if (number.kind != NumberKind::kFinite) {
          const bool word = number.kind == NumberKind::kNoNumber;
          return complain(word ? ErrorCode::kSyntax : ErrorCode::kNonFinite,
                          "vertex " + std::to_string(i) + ": " + quoted(token) +
                              (word ? " is no number" : " is not finite"),
                          "/vertices/" + std::to_string(i));
        }
        value = number.value;
      }
      surface_.vertices.push_back({values[0], values[1], values[2]});
    }
    return {};
  }

  // "corners v1 v2 ... [colour]".
  Result<void> read_faces() {
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < faces_; ++i) {
      SYMCELL_TRY(next_entry("face", i, faces_));
      const auto count = as_count(lines_.next_token(), "corners");
      if (!count) return error_of(count);
      corners.clear();
      for (std::size_t c = 0; c < *count; ++c) {
        const std::string_view token = lines_.next_token();
        const std::optional<std::int64_t> index = parse_integer(token);
        if (!index) {
          return complain(
              ErrorCode::kSyntax,
              "face " + std::to_string(i) + ": " +
                  (token.empty() ? "a corner is missing" : quoted(token) + " is no vertex index"));
        }
        corners.push_back(*index);
      }
      auto done = internal::append_face(corners, i, place(), surface_);
      if (!done) return done;
    }
    return {};
  }

  TextLines lines_;
  std::size_t vertices_ = 0;
  std::size_t faces_ = 0;
  TriangleSurface surface_;
};

}  // namespace

bool is_off_keyword(std::string_view word) {
  if (!word.ends_with("OFF") && !word.ends_with("off")) return false;
  word.remove_suffix(3);
  // In this order, each once or not at all.
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"}) {
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  }
  return word.empty();
}

Result<TriangleSurface> read_off(std::string_view bytes) {
  return OffReader(bytes).read();
}

}  // namespace symcell
