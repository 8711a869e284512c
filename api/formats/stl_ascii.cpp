// The text form of STL:
//   solid NAME
//     facet normal X Y Z
//       outer loop
//         vertex X Y Z   (three times)
//       endloop
//     endfacet
//   endsolid NAME
// Words in any case, any white space.
#include <algorithm>
#include <cctype>
#include <string>

#include "api/formats/stl.hpp"
#include "api/formats/surface_reading.hpp"
#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell::internal {
namespace {

class AsciiStlReader {
 public:
  explicit AsciiStlReader(std::string_view bytes) : rest_(bytes) {}

  Result<TriangleSurface> read() {
    bool in_solid = false;
    if (!next() || !is("solid")) {
      return fail(ErrorCode::kUnknownFormat, "this is no STL file: it is text, but begins with " +
                                                 shown() + " and not with \"solid\"");
    }
    do {
      auto done = Result<void>{};
      if (is("solid") && !in_solid) {
        in_solid = true;
        parts_.begin(rest_.substr(0, rest_.find('\n')));
        skip_line();
      } else if (is("endsolid") && in_solid) {
        in_solid = false;
        skip_line();
      } else if (is("facet") && in_solid) {
        done = read_facet();
        parts_.follow(surface_);
      } else {
        done = complain(ErrorCode::kSyntax, shown() + " where \"" +
                                                (in_solid ? "facet\" or \"endsolid" : "solid") +
                                                "\" should stand");
      }
      if (!done) return error_of(done);
    } while (next());
    if (in_solid) {
      return complain(ErrorCode::kTruncated, "the file ends without \"endsolid\", after triangle " +
                                                 std::to_string(surface_.triangles.size()));
    }
    parts_.give_to(surface_);
    return std::move(surface_);
  }

 private:
  // The next word; false at the end of the file.
  bool next() {
    std::size_t begin = 0;
    while (begin < rest_.size() && blank(rest_[begin])) {
      if (rest_[begin] == '\n') ++line_;
      ++begin;
    }
    rest_.remove_prefix(begin);
    std::size_t end = 0;
    while (end < rest_.size() && !blank(rest_[end])) ++end;
    word_ = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return end > 0;
  }

  static bool blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
  }

  // To the end of the line: a name may have several words.
  void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }

  // `keyword` in lower case.
  [[nodiscard]] bool is(std::string_view keyword) const {
    return std::ranges::equal(word_, keyword, [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) == b;
    });
  }

  [[nodiscard]] std::string shown() const { return "\"" + printable(word_) + "\""; }
  [[nodiscard]] std::string triangle() const {
    return "triangle " + std::to_string(surface_.triangles.size());
  }

  [[nodiscard]] Failure complain(ErrorCode code, const std::string& what) const {
    const auto t = static_cast<std::int64_t>(surface_.triangles.size());
    return fail(code, "line " + std::to_string(line_) + ": " + what, {t},
                "/triangles/" + std::to_string(t));
  }

  Result<void> expect(std::string_view keyword) {
    if (!next()) {
      return complain(ErrorCode::kTruncated, "the file ends in " + triangle() + ", before \"" +
                                                 std::string(keyword) + "\"");
    }
    if (is(keyword)) return {};
    return complain(ErrorCode::kSyntax, triangle() + ": " + shown() + " where \"" +
                                            std::string(keyword) + "\" should stand");
  }

  // Normals are not looked at; some writers put "nan" or "-nan(ind)" there, or leave them out.
  Result<void> skip_normal() {
    constexpr int kMostWords = 5;  // "normal x y z outer"
    for (int i = 0; i < kMostWords; ++i) {
      if (!next()) return complain(ErrorCode::kTruncated, "the file ends in " + triangle());
      if (is("outer")) return expect("loop");
    }
    return complain(ErrorCode::kSyntax,
                    triangle() + ": " + shown() + " where \"outer loop\" should stand");
  }

  Result<double> coordinate() {
    if (!next()) {
      return complain(ErrorCode::kTruncated, "the file ends in a vertex of " + triangle());
    }
    const ParsedNumber number = parse_number(word_);
    if (number.kind == NumberKind::kFinite) return number.value;
    if (number.kind == NumberKind::kNonFinite) {
      return complain(ErrorCode::kNonFinite, triangle() + ": " + shown() + " is not finite");
    }
    return complain(ErrorCode::kSyntax, triangle() + ": " + shown() + " is no number");
  }

  Result<void> read_facet() {
    SYMCELL_TRY(skip_normal());
    const auto first = static_cast<std::int32_t>(surface_.vertices.size());
    for (int v = 0; v < 3; ++v) {
      SYMCELL_TRY(expect("vertex"));
      double values[3] = {};
      for (double& value : values) {
        const Result<double> read = coordinate();
        if (!read) return error_of(read);
        value = *read;
      }
      surface_.vertices.push_back({values[0], values[1], values[2]});
    }
    SYMCELL_TRY(expect("endloop"));
    SYMCELL_TRY(expect("endfacet"));
    if (surface_.triangles.size() == kMaxSurfaceTriangles) {
      return complain(ErrorCode::kTooLarge,
                      "more than " + std::to_string(kMaxSurfaceTriangles) + " triangles");
    }
    surface_.triangles.push_back({first, first + 1, first + 2});
    return {};
  }

  std::string_view rest_;
  std::string_view word_;
  std::size_t line_ = 1;
  TriangleSurface surface_;
  PartNames parts_;
};

}  // namespace

Result<TriangleSurface> read_ascii_stl(std::string_view bytes) {
  return AsciiStlReader(bytes).read();
}

}  // namespace symcell::internal
