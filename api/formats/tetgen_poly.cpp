#include "api/formats/tetgen_poly.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "api/formats/text_lines.hpp"
#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell {
namespace {

std::string quoted(std::string_view token) {
  return "\"" + printable(token) + "\"";
}

class TetgenReader {
 public:
  TetgenReader(std::string_view bytes, TetgenForm form) : lines_(bytes), form_(form) {}

  Result<Plc> read() {
    auto done = read_vertices();
    if (done) done = read_facets();
    if (done) done = read_holes();
    if (done) done = read_regions();
    if (done && lines_.next_line()) {
      done = complain(ErrorCode::kCountMismatch,
                      "the file goes on after its last section; are the counts right?");
    }
    if (!done) return error_of(done);
    return std::move(plc_);
  }

 private:
  // A section's header: how many entries, and what follows on the line.
  struct Header {
    std::size_t count = 0;
    std::string_view second;
    bool present = false;
  };

  [[nodiscard]] Failure complain(ErrorCode code,
                                 const std::string& what,
                                 std::string pointer = {}) const {
    return fail(code, "line " + std::to_string(lines_.number()) + ": " + what, {},
                std::move(pointer));
  }

  // A count is trusted only as far as the bytes left can bear it, two of them an entry at least.
  [[nodiscard]] Result<std::size_t> as_count(std::string_view token,
                                             const std::string& what) const {
    const std::optional<std::int64_t> count = parse_integer(token);
    if (!count || *count < 0) {
      return complain(ErrorCode::kSyntax, quoted(token) + " is no number of " + what);
    }
    const auto most = static_cast<std::int64_t>(lines_.bytes_left() / 2 + 1);
    if (*count > most) {
      return complain(ErrorCode::kCountMismatch, "here should follow " + std::to_string(*count) +
                                                     " " + what + ", but at most " +
                                                     std::to_string(most) + " can");
    }
    if (static_cast<std::size_t>(*count) > kMaxPlcCorners) {
      return complain(ErrorCode::kTooLarge,
                      std::to_string(*count) + " " + what + " are more than can be meshed");
    }
    return static_cast<std::size_t>(*count);
  }

  Result<Header> read_header(const std::string& what, bool required) {
    if (!lines_.next_line()) {
      if (!required) return Header{};
      return complain(ErrorCode::kTruncated,
                      "the file ends where the number of " + what + " should stand");
    }
    const Result<std::size_t> count = as_count(lines_.next_token(), what);
    if (!count) return error_of(count);
    return Header{*count, lines_.next_token(), true};
  }

  // Goes to the line of an entry.
  Result<void> next_entry(const std::string& what, std::size_t i, std::size_t count) {
    if (lines_.next_line()) return {};
    return complain(ErrorCode::kTruncated, "the file ends where " + what + " " +
                                               std::to_string(i + 1) + " of " +
                                               std::to_string(count) + " should stand");
  }

  // Entries of most sections are numbered; gaps and steps back mean that a count is wrong.
  Result<void> read_number(const std::string& what, std::size_t i, std::int64_t& first) {
    const std::string_view token = lines_.next_token();
    const std::optional<std::int64_t> number = parse_integer(token);
    if (!number) return complain(ErrorCode::kSyntax, quoted(token) + " is no number of a " + what);
    if (i == 0) first = *number == 0 ? 0 : 1;
    const std::int64_t expected = first + static_cast<std::int64_t>(i);
    if (*number == expected) return {};
    return complain(ErrorCode::kCountMismatch,
                    "a " + what + " of number " + std::to_string(expected) +
                        " should stand here, not " + std::to_string(*number) +
                        "; is the count right?");
  }

  [[nodiscard]] Result<double> as_real(std::string_view token, const std::string& pointer) const {
    if (token.empty()) return complain(ErrorCode::kSyntax, "a number is missing", pointer);
    const ParsedNumber number = parse_number(token);
    if (number.kind == NumberKind::kFinite) return number.value;
    if (number.kind == NumberKind::kNoNumber) {
      return complain(ErrorCode::kSyntax, quoted(token) + " is no number", pointer);
    }
    return complain(ErrorCode::kNonFinite, quoted(token) + " is not finite", pointer);
  }

  Result<Point3> read_point(const std::string& pointer) {
    double values[3] = {};
    for (int i = 0; i < 3; ++i) {
      const auto value = as_real(lines_.next_token(), pointer + "/" + std::to_string(i));
      if (!value) return error_of(value);
      values[i] = *value;
    }
    return Point3{values[0], values[1], values[2]};
  }

  // Markers and attributes: whole numbers, also as 2.0.
  [[nodiscard]] Result<std::int32_t> as_label(std::string_view token,
                                              const std::string& pointer) const {
    const Result<double> number = as_real(token, pointer);
    if (!number) return error_of(number);
    const std::optional<std::int32_t> whole = whole_int32(*number);
    if (whole) return *whole;
    return complain(ErrorCode::kSyntax,
                    quoted(token) + " is no marker or attribute: they are whole numbers of 32 bits",
                    pointer);
  }

  [[nodiscard]] Result<std::int32_t> as_index(std::string_view token,
                                              const std::string& pointer) const {
    const std::optional<std::int64_t> number = parse_integer(token);
    if (!number) {
      return complain(ErrorCode::kSyntax, quoted(token) + " is no vertex number", pointer);
    }
    const std::int64_t index = *number - first_vertex_;
    if (*number < std::numeric_limits<std::int32_t>::min() + 1 ||
        *number > std::numeric_limits<std::int32_t>::max()) {
      return complain(ErrorCode::kIndexOutOfRange, "there is no vertex " + quoted(token), pointer);
    }
    return static_cast<std::int32_t>(index);
  }

  // --- Sections. --------------------------------------------------------------------------------
  Result<void> read_vertices() {
    const Result<Header> header = read_header("vertices", true);
    if (!header) return error_of(header);
    if (header->count == 0) {
      return complain(ErrorCode::kMissingField,
                      "the vertices are in a separate .node file; put them into this file");
    }
    if (header->count > kMaxPlcVertices) {
      return complain(ErrorCode::kTooLarge, std::to_string(header->count) + " vertices; at most " +
                                                std::to_string(kMaxPlcVertices) + " are taken");
    }
    if (header->second == "2") {
      return complain(ErrorCode::kUnsupportedModel,
                      "a planar model (dimension 2) where a solid one was expected");
    }
    if (header->second != "3") {
      return complain(ErrorCode::kSyntax, "the dimension must be 3, not " + quoted(header->second));
    }
    for (std::size_t i = 0; i < header->count; ++i) {
      auto done = next_entry("vertex", i, header->count);
      if (done) done = read_number("vertex", i, first_vertex_);
      if (!done) return done;
      const auto p = read_point("/vertices/" + std::to_string(i));
      if (!p) return error_of(p);
      plc_.vertices.push_back(*p);
    }
    return {};
  }

  Result<void> read_facets() {
    const Result<Header> header = read_header("facets", true);
    if (!header) return error_of(header);
    const bool marked = !header->second.empty() && header->second != "0";
    for (std::size_t i = 0; i < header->count; ++i) {
      auto done = next_entry("facet", i, header->count);
      if (!done) return done;
      PlcFacet facet;
      const std::string pointer = "/facets/" + std::to_string(i);
      done = form_ == TetgenForm::kPoly ? read_facet(facet, marked, pointer)
                                        : read_smesh_facet(facet, marked, pointer);
      if (!done) return done;
      plc_.facets.push_back(std::move(facet));
    }
    return {};
  }

  // "polygons [holes [marker]]", the polygons, the holes.
  Result<void> read_facet(PlcFacet& facet, bool marked, const std::string& pointer) {
    const auto polygons = as_count(lines_.next_token(), "polygons");
    if (!polygons) return error_of(polygons);
    std::size_t holes = 0;
    if (const std::string_view token = lines_.next_token(); !token.empty()) {
      const auto count = as_count(token, "holes of the facet");
      if (!count) return error_of(count);
      holes = *count;
      if (const std::string_view label = lines_.next_token(); marked && !label.empty()) {
        const auto marker = as_label(label, pointer + "/marker");
        if (!marker) return error_of(marker);
        facet.marker = *marker;
      }
    }
    for (std::size_t i = 0; i < *polygons; ++i) {
      auto done = next_entry("polygon", i, *polygons);
      if (done) done = read_polygon(facet, pointer + "/polygons/" + std::to_string(i));
      if (!done) return done;
    }
    std::int64_t first = 1;
    for (std::size_t i = 0; i < holes; ++i) {
      auto done = next_entry("hole", i, holes);
      if (done) done = read_number("hole", i, first);
      if (!done) return done;
      const auto p = read_point(pointer + "/holes/" + std::to_string(i));
      if (!p) return error_of(p);
      facet.holes.push_back(*p);
    }
    return {};
  }

  Result<void> read_smesh_facet(PlcFacet& facet, bool marked, const std::string& pointer) {
    auto done = read_polygon(facet, pointer + "/polygons/0");
    if (!done || !marked) return done;
    const std::string_view token = lines_.next_token();
    if (token.empty()) return {};
    const auto marker = as_label(token, pointer + "/marker");
    if (!marker) return error_of(marker);
    facet.marker = *marker;
    return {};
  }

  // "corners c1 c2 ...", also over several lines.
  Result<void> read_polygon(PlcFacet& facet, const std::string& pointer) {
    const auto count = as_count(lines_.next_token(), "corners of the polygon");
    if (!count) return error_of(count);
    corners_ += *count + 1;
    if (corners_ > kMaxPlcCorners) {
      return complain(ErrorCode::kTooLarge,
                      "more than " + std::to_string(kMaxPlcCorners) + " corners of polygons");
    }
    std::vector<std::int32_t>& polygon = facet.polygons.emplace_back();
    for (std::size_t i = 0; i < *count; ++i) {
      const std::string_view token = lines_.next_token_anywhere();
      if (token.empty()) {
        return complain(ErrorCode::kTruncated,
                        "the file ends in a polygon of " + std::to_string(*count) + " corners");
      }
      const auto index = as_index(token, pointer + "/" + std::to_string(i));
      if (!index) return error_of(index);
      polygon.push_back(*index);
    }
    return {};
  }

  Result<void> read_holes() {
    const Result<Header> header = read_header("holes", true);
    if (!header) return error_of(header);
    std::int64_t first = 1;
    for (std::size_t i = 0; i < header->count; ++i) {
      auto done = next_entry("hole", i, header->count);
      if (done) done = read_number("hole", i, first);
      if (!done) return done;
      const auto p = read_point("/holes/" + std::to_string(i));
      if (!p) return error_of(p);
      plc_.holes.push_back(*p);
    }
    return {};
  }

  Result<void> read_regions() {
    const Result<Header> header = read_header("regions", false);
    if (!header) return error_of(header);
    std::int64_t first = 1;
    for (std::size_t i = 0; i < header->count; ++i) {
      auto done = next_entry("region", i, header->count);
      if (done) done = read_number("region", i, first);
      if (!done) return done;
      const std::string pointer = "/regions/" + std::to_string(i);
      const auto p = read_point(pointer + "/point");
      if (!p) return error_of(p);
      const auto attribute = as_label(lines_.next_token(), pointer + "/attribute");
      if (!attribute) return error_of(attribute);
      PlcRegion region{*p, *attribute, std::numeric_limits<double>::infinity()};
      if (const std::string_view token = lines_.next_token(); !token.empty()) {
        const auto volume = as_real(token, pointer + "/max_volume");
        if (!volume) return error_of(volume);
        if (*volume > 0) region.max_volume = *volume;
      }
      plc_.regions.push_back(region);
    }
    return {};
  }

  TextLines lines_;
  TetgenForm form_;
  std::int64_t first_vertex_ = 1;
  std::size_t corners_ = 0;  // of all polygons
  Plc plc_;
};

}  // namespace

Result<Plc> read_tetgen(std::string_view bytes, TetgenForm form) {
  return TetgenReader(bytes, form).read();
}

std::optional<int> poly_dimension(std::string_view bytes) {
  TextLines lines(bytes);
  if (!lines.next_line() || !parse_integer(lines.next_token())) return std::nullopt;
  const std::string_view dimension = lines.next_token();
  if (dimension == "2") return 2;
  if (dimension == "3") return 3;
  return std::nullopt;
}

}  // namespace symcell
