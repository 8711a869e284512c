#include "api/formats/obj.hpp"

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

class ObjReader {
 public:
  explicit ObjReader(std::string_view bytes) : lines_(bytes) {}

  Result<TriangleSurface> read() {
    while (lines_.next_line()) {
      const std::string_view keyword = lines_.next_token();
      continued_ = false;
      auto done = Result<void>{};
      if (keyword == "v") {
        done = read_vertex();
      } else if (keyword == "f" || keyword == "fo") {
        done = read_face();
        for (PartNames* names : {&groups_, &materials_, &objects_}) names->follow(surface_);
      } else if (keyword == "g") {
        groups_.begin(lines_.rest());
      } else if (keyword == "usemtl") {
        materials_.begin(lines_.rest());
      } else if (keyword == "o") {
        objects_.begin(lines_.rest());
      }
      if (!done) return error_of(done);
    }
    // The finest division that the file makes, as a rule.
    for (const PartNames* names : {&groups_, &materials_, &objects_}) {
      if (surface_.groups.empty()) names->give_to(surface_);
    }
    return internal::finished(std::move(surface_), "OBJ");
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

  // A backslash at the end of a line continues it, also one that touches the last token.
  std::string_view next_token() {
    std::string_view token = lines_.next_token();
    if (token.empty() && continued_) {
      continued_ = false;
      if (lines_.next_line()) token = lines_.next_token();
    }
    if (!token.ends_with('\\')) return token;
    continued_ = true;
    token.remove_suffix(1);
    return token.empty() ? next_token() : token;
  }

  Result<void> read_vertex() {
    const std::size_t i = surface_.vertices.size();
    const std::string pointer = "/vertices/" + std::to_string(i);
    if (i == kMaxSurfaceTriangles) {
      return complain(ErrorCode::kTooLarge, "more than " + std::to_string(i) + " vertices",
                      pointer);
    }
    double values[3] = {};
    for (double& value : values) {
      const std::string_view token = next_token();
      const ParsedNumber number = parse_number(token);
      if (number.kind != NumberKind::kFinite) {
        const bool word = number.kind == NumberKind::kNoNumber;
        return complain(word ? ErrorCode::kSyntax : ErrorCode::kNonFinite,
                        "vertex " + std::to_string(i) + ": " + quoted(token) +
                            (word ? " is no number" : " is not finite"),
                        pointer);
      }
      value = number.value;
    }
    surface_.vertices.push_back({values[0], values[1], values[2]});
    return {};
  }

  Result<void> read_face() {
    std::vector<std::int64_t> corners;
    const std::string name = "face " + std::to_string(faces_);
    for (std::string_view token = next_token(); !token.empty(); token = next_token()) {
      const std::optional<std::int64_t> number = parse_integer(token.substr(0, token.find('/')));
      if (!number) {
        return complain(ErrorCode::kSyntax, name + ": " + quoted(token) + " is no corner");
      }
      const auto so_far = static_cast<std::int64_t>(surface_.vertices.size());
      const bool known = *number > 0 ? *number <= so_far : *number < 0 && *number >= -so_far;
      if (!known) {
        return complain(ErrorCode::kIndexOutOfRange,
                        name + ": there is no vertex " + quoted(token) + " among the " +
                            std::to_string(so_far) + " before this line (counted from 1)",
                        "/faces/" + std::to_string(faces_));
      }
      corners.push_back(*number > 0 ? *number - 1 : so_far + *number);
    }
    return internal::append_face(corners, faces_++, place(), surface_);
  }

  using PartNames = internal::PartNames;

  TextLines lines_;
  PartNames groups_, materials_, objects_;
  bool continued_ = false;  // the line ends with a backslash
  std::size_t faces_ = 0;
  TriangleSurface surface_;
};

}  // namespace

Result<TriangleSurface> read_obj(std::string_view bytes) {
  return ObjReader(bytes).read();
}

}  // namespace symcell
