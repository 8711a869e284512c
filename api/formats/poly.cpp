#include "api/formats/poly.hpp"

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "api/formats/text_lines.hpp"
#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell {
namespace {

// One line's leading tokens; what follows them is not looked at.
struct Line {
  static constexpr std::size_t kMostTokens = 8;
  std::array<std::string_view, kMostTokens> tokens;
  std::size_t count = 0;
};

class PolyReader {
 public:
  explicit PolyReader(std::string_view bytes) : lines_(bytes) {}

  Result<Pslg> read() {
    auto done = read_vertices();
    if (done) done = read_segments();
    if (done) done = read_holes();
    if (done) done = read_regions();
    if (done && next_line()) {
      done = complain(ErrorCode::kCountMismatch,
                      "the file goes on after its last section; are the counts right?");
    }
    if (!done) return error_of(done);
    return std::move(pslg_);
  }

 private:
  bool next_line() {
    line_.count = 0;
    if (!lines_.next_line()) return false;
    while (line_.count < Line::kMostTokens) {
      const std::string_view token = lines_.next_token();
      if (token.empty()) break;
      line_.tokens[line_.count++] = token;
    }
    return true;
  }

  Failure complain(ErrorCode code, const std::string& what, std::string pointer = {}) {
    return fail(code, "line " + std::to_string(lines_.number()) + ": " + what, {},
                std::move(pointer));
  }

  // Reads a section's header; `nullopt` in the optional section at the end of the file.
  Result<std::optional<std::size_t>> read_count(const std::string& what, bool required) {
    if (!next_line()) {
      if (!required) return std::optional<std::size_t>{};
      return complain(ErrorCode::kTruncated,
                      "the file ends where the number of " + what + " should stand");
    }
    const std::optional<std::int64_t> count = parse_integer(line_.tokens[0]);
    if (!count || *count < 0) {
      return complain(ErrorCode::kSyntax,
                      "\"" + printable(line_.tokens[0]) + "\" is no number of " + what);
    }
    // An entry takes at least "1 2 3" and a line's end, the last one perhaps without.
    const auto most = static_cast<std::int64_t>(lines_.bytes_left() / 6 + 1);
    if (*count > most) {
      return complain(ErrorCode::kCountMismatch, "the header says " + std::to_string(*count) + " " +
                                                     what + ", but at most " +
                                                     std::to_string(most) + " can follow");
    }
    if (static_cast<std::size_t>(*count) > 4 * kMaxPslgVertices) {
      return complain(ErrorCode::kTooLarge,
                      std::to_string(*count) + " " + what + " are more than can be meshed");
    }
    return std::optional<std::size_t>(static_cast<std::size_t>(*count));
  }

  // Reads entry `i` of `count`. A section's first entry is number 0 or 1, the others follow on.
  Result<void> read_entry(const std::string& what,
                          std::size_t i,
                          std::size_t count,
                          std::size_t tokens) {
    const auto position = [&] {
      return what + " " + std::to_string(i + 1) + " of " + std::to_string(count);
    };
    if (!next_line()) {
      return complain(ErrorCode::kTruncated, "the file ends where " + position() + " should stand");
    }
    const std::optional<std::int64_t> number = parse_integer(line_.tokens[0]);
    if (!number) {
      return complain(ErrorCode::kSyntax,
                      "\"" + printable(line_.tokens[0]) + "\" is no number of a " + what);
    }
    if (i == 0) section_first_ = *number == 0 ? 0 : 1;
    const std::int64_t expected = section_first_ + static_cast<std::int64_t>(i);
    if (*number != expected) {
      return complain(ErrorCode::kCountMismatch,
                      position() + " should have number " + std::to_string(expected) + ", not " +
                          std::to_string(*number) + "; is the count right?");
    }
    if (line_.count < tokens) {
      return complain(ErrorCode::kSyntax, position() + " needs " + std::to_string(tokens) +
                                              " numbers, here are " + std::to_string(line_.count));
    }
    return {};
  }

  Result<double> real(std::size_t token, const std::string& pointer) {
    const ParsedNumber number = parse_number(line_.tokens[token]);
    if (number.kind == NumberKind::kFinite) return number.value;
    const std::string shown = "\"" + printable(line_.tokens[token]) + "\"";
    if (number.kind == NumberKind::kNoNumber) {
      return complain(ErrorCode::kSyntax, shown + " is no number", pointer);
    }
    return complain(ErrorCode::kNonFinite, shown + " is not finite", pointer);
  }

  Result<Point2> point(std::size_t token, const std::string& pointer) {
    const Result<double> x = real(token, pointer + "/0");
    if (!x) return error_of(x);
    const Result<double> y = real(token + 1, pointer + "/1");
    if (!y) return error_of(y);
    return Point2{*x, *y};
  }

  Result<std::int32_t> index(std::size_t token, const std::string& pointer) {
    const std::optional<std::int64_t> number = parse_integer(line_.tokens[token]);
    const std::string shown = "\"" + printable(line_.tokens[token]) + "\"";
    if (!number) return complain(ErrorCode::kSyntax, shown + " is no vertex number", pointer);
    const std::int64_t index = *number - first_vertex_;
    if (index < std::numeric_limits<std::int32_t>::min() ||
        index > std::numeric_limits<std::int32_t>::max()) {
      return complain(ErrorCode::kIndexOutOfRange, "there is no vertex " + shown, pointer);
    }
    return static_cast<std::int32_t>(index);
  }

  // Markers and attributes: whole numbers, also as 2.0.
  Result<std::int32_t> label(std::size_t token, const std::string& pointer) {
    const Result<double> number = real(token, pointer);
    if (!number) return error_of(number);
    const std::optional<std::int32_t> whole = whole_int32(*number);
    if (!whole) {
      return complain(ErrorCode::kSyntax,
                      "\"" + printable(line_.tokens[token]) +
                          "\" is no marker or attribute: they are whole numbers of 32 bits",
                      pointer);
    }
    return *whole;
  }

  Result<void> read_vertices() {
    const auto count = read_count("vertices", true);
    if (!count) return error_of(count);
    const std::size_t total = **count;
    if (total == 0) {
      return complain(ErrorCode::kMissingField,
                      "the vertices are in a separate .node file; put them into the .poly file");
    }
    if (total > kMaxPslgVertices) {
      return complain(ErrorCode::kTooLarge, std::to_string(total) + " vertices; at most " +
                                                std::to_string(kMaxPslgVertices) + " are taken");
    }
    if (line_.count > 1 && line_.tokens[1] == "3") {
      return complain(ErrorCode::kUnsupportedModel,
                      "a solid model (dimension 3) where a planar one was expected");
    }
    if (line_.count > 1 && line_.tokens[1] != "2") {
      return complain(ErrorCode::kSyntax,
                      "the dimension must be 2, not \"" + printable(line_.tokens[1]) + "\"");
    }
    for (std::size_t i = 0; i < total; ++i) {
      const auto entry = read_entry("vertex", i, total, 3);
      if (!entry) return entry;
      const Result<Point2> p = point(1, "/vertices/" + std::to_string(i));
      if (!p) return error_of(p);
      pslg_.vertices.push_back(*p);
    }
    first_vertex_ = section_first_;
    return {};
  }

  Result<void> read_segments() {
    const auto count = read_count("segments", true);
    if (!count) return error_of(count);
    const bool marked = line_.count > 1 && line_.tokens[1] != "0";
    for (std::size_t i = 0; i < **count; ++i) {
      const auto entry = read_entry("segment", i, **count, marked ? 4 : 3);
      if (!entry) return entry;
      const std::string pointer = "/segments/" + std::to_string(i);
      const Result<std::int32_t> a = index(1, pointer + "/0");
      if (!a) return error_of(a);
      const Result<std::int32_t> b = index(2, pointer + "/1");
      if (!b) return error_of(b);
      Result<std::int32_t> marker = 0;
      if (marked) marker = label(3, pointer + "/2");
      if (!marker) return error_of(marker);
      pslg_.segments.push_back({*a, *b, *marker});
    }
    return {};
  }

  Result<void> read_holes() {
    const auto count = read_count("holes", true);
    if (!count) return error_of(count);
    for (std::size_t i = 0; i < **count; ++i) {
      const auto entry = read_entry("hole", i, **count, 3);
      if (!entry) return entry;
      const Result<Point2> p = point(1, "/holes/" + std::to_string(i));
      if (!p) return error_of(p);
      pslg_.holes.push_back(*p);
    }
    return {};
  }

  Result<void> read_regions() {
    const auto count = read_count("regions", false);
    if (!count) return error_of(count);
    if (!count->has_value()) return {};
    for (std::size_t i = 0; i < **count; ++i) {
      const auto entry = read_entry("region", i, **count, 4);
      if (!entry) return entry;
      const std::string pointer = "/regions/" + std::to_string(i);
      const Result<Point2> p = point(1, pointer + "/point");
      if (!p) return error_of(p);
      const Result<std::int32_t> attribute = label(3, pointer + "/attribute");
      if (!attribute) return error_of(attribute);
      PslgRegion region{*p, *attribute, std::numeric_limits<double>::infinity()};
      if (line_.count > 4) {
        const Result<double> area = real(4, pointer + "/max_area");
        if (!area) return error_of(area);
        if (*area > 0) region.max_area = *area;
      }
      pslg_.regions.push_back(region);
    }
    return {};
  }

  TextLines lines_;
  Line line_;
  std::int64_t section_first_ = 1;  // number of the first entry of the section being read
  std::int64_t first_vertex_ = 1;
  Pslg pslg_;
};

}  // namespace

Result<Pslg> read_poly(std::string_view bytes) {
  return PolyReader(bytes).read();
}

}  // namespace symcell
