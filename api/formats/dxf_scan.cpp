#include "api/formats/dxf_scan.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "api/formats/byte_order_mark.hpp"
#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"
#include "core/model/describe.hpp"

namespace symcell {
namespace {

constexpr std::size_t kMostEntities = 10'000'000;
constexpr std::size_t kLongestName = 255;  // as the format has it
constexpr std::string_view kBinary = "AutoCAD Binary DXF";

// Kinds of group values, by code.
constexpr int kType = 0, kName = 2, kColour = 62, kInvisible = 60, kPaperSpace = 67, kFlags = 70;
constexpr std::int64_t kFrozen = 1;  // among the flags of a layer
bool is_real(int code) {
  return (code >= 10 && code <= 59) || (code >= 210 && code <= 239);
}
bool is_whole(int code) {
  return (code >= 60 && code <= 79) || (code >= 90 && code <= 99);
}

// Entities that are read, and their groups that matter.
struct Kept {
  std::string_view type;
  std::array<int, 18> codes;  // 0: no more
};
constexpr std::array kKept{
    Kept{"LINE", {8, 10, 20, 30, 11, 21, 31}},
    Kept{"POINT", {8, 10, 20, 30}},
    Kept{"ARC", {8, 10, 20, 30, 40, 50, 51, 210, 220, 230}},
    Kept{"CIRCLE", {8, 10, 20, 30, 40, 210, 220, 230}},
    Kept{"ELLIPSE", {8, 10, 20, 30, 11, 21, 31, 40, 41, 42, 210, 220, 230}},
    Kept{"LWPOLYLINE", {8, 90, 70, 10, 20, 42, 210, 220, 230}},
    Kept{"POLYLINE", {8, 70, 71, 72, 210, 220, 230}},
    Kept{"VERTEX", {8, 10, 20, 30, 42, 70}},
    Kept{"SEQEND", {8}},
    Kept{"SPLINE", {8, 70, 71, 72, 73, 74, 40, 41, 10, 20, 30, 11, 21, 31}},
    Kept{"INSERT", {8, 2, 10, 20, 30, 41, 42, 43, 50, 70, 71, 44, 45, 210, 220, 230}},
    Kept{"BLOCK", {8, 2, 10, 20, 30, 70}},
    Kept{"ENDBLK", {8}},
};

const Kept* kept(std::string_view type) {
  const auto* found = std::ranges::find(kKept, type, &Kept::type);
  return found == kKept.end() ? nullptr : found;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

struct Group {
  int code = 0;
  std::string value;  // numbers as they are written anew
  std::size_t line = 0;
};

struct Layer {
  std::string name;
  bool hidden = false;
};

class Scanner {
 public:
  explicit Scanner(std::string_view bytes) : rest_(bytes) {}

  Result<DxfScan> run() {
    while (true) {
      auto group = next_group();
      if (!group) return error_of(group);
      if (!*group) return truncated();
      const Group& g = **group;
      if (g.code == 999) continue;  // a comment
      if (g.code == kType) {
        SYMCELL_TRY(close_entity());
        if (g.value == "EOF") break;
        SYMCELL_TRY(open(g));
      } else if (in_header_) {
        if (g.code == kName) section_ = g.value;
        in_header_ = false;
        if (is_read(section_)) result_.text += "0\nSECTION\n2\n" + section_ + "\n";
      } else if (section_ == "TABLES") {
        look_at_layer(g);
      } else if (kept_ != nullptr) {
        SYMCELL_TRY(take(g));
      }
    }
    if (!section_.empty()) {
      return complain(ErrorCode::kTruncated, number_,
                      "the file ends within the section " + printable(section_));
    }
    result_.text += "0\nEOF\n";
    for (const auto& [type, count] : left_out_) {
      result_.left_out.push_back(std::to_string(count) + " " + printable(type, 24));
    }
    return std::move(result_);
  }

 private:
  static bool is_read(const std::string& section) {
    return section == "ENTITIES" || section == "BLOCKS";
  }

  static Failure complain(ErrorCode code, std::size_t line, const std::string& what) {
    return fail(code, "line " + std::to_string(line) + ": " + what);
  }

  [[nodiscard]] std::string entity() const {
    return type_ + (type_.empty() ? "" : " of line " + std::to_string(line_));
  }

  [[nodiscard]] Failure truncated() const {
    const std::string where = type_.empty() ? section_.empty() ? "" : " in " + printable(section_)
                                            : " within the " + entity();
    return complain(ErrorCode::kTruncated, number_,
                    "the file ends" + where + ", before its EOF; was it written completely?");
  }

  std::optional<std::string_view> next_line() {
    if (rest_.empty()) return std::nullopt;
    ++number_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return trimmed(line);
  }

  // Nothing at the end of the file.
  Result<std::optional<Group>> next_group() {
    const auto code_text = next_line();
    if (!code_text) return std::optional<Group>{};
    const std::size_t line = number_;
    const auto code = parse_integer(*code_text);
    if (!code || *code < 0 || *code > 1071) {
      const std::string within = type_.empty() ? "" : " within the " + entity();
      return complain(ErrorCode::kSyntax, line,
                      "\"" + printable(*code_text, 24) + "\" is no group code" + within +
                          "; a DXF file has a code and a value in turn");
    }
    const auto value = next_line();
    if (!value) return std::optional<Group>{};
    return std::optional<Group>{{static_cast<int>(*code), std::string(*value), line}};
  }

  Result<void> open(const Group& g) {
    if (g.value == "SECTION") {
      if (!section_.empty()) {
        return complain(ErrorCode::kSyntax, g.line,
                        "a section begins within the section " + printable(section_));
      }
      in_header_ = true;
      return {};
    }
    if (layer_) end_layer();
    if (section_ == "TABLES" && g.value == "LAYER") layer_.emplace();
    if (g.value == "ENDSEC") {
      if (is_read(section_)) result_.text += "0\nENDSEC\n";
      section_.clear();
      return {};
    }
    if (!is_read(section_)) return {};
    type_ = g.value;
    line_ = g.line;
    kept_ = kept(type_);
    if (kept_ == nullptr) {
      // What belongs to an entity before goes with it.
      if (type_ != "ATTRIB" && type_ != "ATTDEF") ++left_out_[type_];
      type_.clear();
    }
    return {};
  }

  void look_at_layer(const Group& g) {
    if (!layer_) return;
    if (g.code == kName) layer_->name = g.value;
    if (g.code == kColour) layer_->hidden |= g.value.starts_with('-');  // it is off
    if (g.code == kFlags) {
      const auto flags = parse_integer(g.value);
      layer_->hidden |= flags && (*flags & kFrozen) != 0;
    }
  }
  void end_layer() {
    if (layer_->hidden) result_.hidden_layers.insert(layer_->name);
    layer_.reset();
  }

  Result<void> take(const Group& g) {
    if (g.code == kInvisible || g.code == kPaperSpace) {
      hidden_ = hidden_ || g.value != "0";
      return {};
    }
    if (std::ranges::find(kept_->codes, g.code) == kept_->codes.end()) return {};
    Group group = g;
    if (is_real(g.code)) {
      const ParsedNumber number = parse_number(g.value);
      if (number.kind != NumberKind::kFinite) {
        const bool none = number.kind == NumberKind::kNoNumber;
        return complain(none ? ErrorCode::kSyntax : ErrorCode::kNonFinite, g.line + 1,
                        "\"" + printable(g.value, 24) + "\" is no " + (none ? "" : "finite ") +
                            "number, group " + std::to_string(g.code) + " of the " + entity());
      }
      group.value = describe_number(number.value);
    } else if (is_whole(g.code)) {
      const auto whole = parse_integer(g.value);
      if (!whole || *whole < INT32_MIN || *whole > INT32_MAX) {
        return complain(ErrorCode::kSyntax, g.line + 1,
                        "\"" + printable(g.value, 24) + "\" is no whole number, group " +
                            std::to_string(g.code) + " of the " + entity());
      }
      group.value = std::to_string(*whole);
    } else if (g.value.size() > kLongestName) {
      return complain(ErrorCode::kSyntax, g.line + 1,
                      "a name of " + std::to_string(g.value.size()) + " bytes in the " + entity());
    }
    groups_.push_back(std::move(group));
    return {};
  }

  [[nodiscard]] std::size_t count(int code) const {
    return static_cast<std::size_t>(std::ranges::count(groups_, code, &Group::code));
  }
  [[nodiscard]] std::optional<std::int64_t> whole(int code) const {
    const auto found = std::ranges::find(groups_, code, &Group::code);
    return found == groups_.end() ? std::nullopt : parse_integer(found->value);
  }

  // A group that says how many of another there are; it is given anew, before all.
  Result<void> settle_count(int code, int of, const char* what) {
    const std::size_t there = count(of);
    const auto said = whole(code);
    if (said && (*said < 0 || static_cast<std::size_t>(*said) != there)) {
      return complain(ErrorCode::kCountMismatch, line_,
                      "the " + entity() + " is said to have " + std::to_string(*said) + " " + what +
                          " and has " + std::to_string(there));
    }
    std::erase_if(groups_, [&](const Group& g) { return g.code == code; });
    groups_.insert(groups_.begin(), {code, std::to_string(there), line_});
    return {};
  }

  Result<void> check_pairs(int x, int y) {
    if (count(x) == count(y)) return {};
    return complain(ErrorCode::kCountMismatch, line_,
                    "the " + entity() + " has " + std::to_string(count(x)) + " x and " +
                        std::to_string(count(y)) + " y coordinates");
  }

  Result<void> check_counts() {
    SYMCELL_TRY(check_pairs(10, 20));
    SYMCELL_TRY(check_pairs(11, 21));
    if (type_ == "LWPOLYLINE") return settle_count(90, 10, "vertices");
    if (type_ == "SPLINE") {
      SYMCELL_TRY(settle_count(74, 11, "fit points"));
      SYMCELL_TRY(settle_count(73, 10, "control points"));
      return settle_count(72, 40, "knots");
    }
    const bool has_place = type_ != "POLYLINE" && type_ != "SEQEND" && type_ != "ENDBLK";
    const bool has_end = type_ == "LINE" || type_ == "ELLIPSE";
    if ((has_place && count(10) != 1 && type_ != "BLOCK") || (has_end && count(11) != 1)) {
      return complain(ErrorCode::kMissingField, line_,
                      "the " + entity() + " has not all of its coordinates");
    }
    return {};
  }

  Result<void> close_entity() {
    if (kept_ == nullptr) return {};
    SYMCELL_TRY(check_counts());
    constexpr int kMesh = 16, kFaces = 64, kFrame = 16;
    const std::int64_t flags = whole(kFlags).value_or(0);
    if (type_ == "POLYLINE") {
      // A mesh of faces is none of the plane; its vertices go with it.
      skips_vertices_ = hidden_ || (flags & (kMesh | kFaces)) != 0;
      if (skips_vertices_ && !hidden_) ++left_out_["POLYLINE of a mesh"];
    }
    const bool of_polyline = type_ == "VERTEX" || type_ == "SEQEND";
    bool drop = hidden_ || (skips_vertices_ && (type_ == "POLYLINE" || of_polyline));
    drop = drop || (type_ == "VERTEX" && (flags & kFrame) != 0);  // of a curve's control polygon
    if (type_ == "SEQEND") skips_vertices_ = false;
    if (!drop) {
      if (result_.entities.size() == kMostEntities) {
        return complain(ErrorCode::kTooLarge, line_,
                        "more than " + std::to_string(kMostEntities) + " entities");
      }
      emit();
    }
    kept_ = nullptr;
    type_.clear();
    groups_.clear();
    hidden_ = false;
    return {};
  }

  void emit() {
    std::string& text = result_.text;
    const auto add = [&](int code, const std::string& value) {
      text += std::to_string(code);
      text += '\n';
      text += value;
      text += '\n';
    };
    add(kType, type_);
    add(kColour, std::to_string(result_.entities.size()));
    for (const Group& g : groups_) add(g.code, g.value);
    result_.entities.push_back({type_, line_});
  }

  std::string_view rest_;
  std::size_t number_ = 0;  // of the line read last
  std::string section_;
  std::optional<Layer> layer_;  // whose record is being read
  bool in_header_ = false;
  std::string type_;  // of the entity that is read; empty: none
  std::size_t line_ = 0;
  const Kept* kept_ = nullptr;
  std::vector<Group> groups_;
  bool hidden_ = false;
  bool skips_vertices_ = false;
  std::map<std::string, std::size_t> left_out_;
  DxfScan result_;
};

}  // namespace

bool looks_like_dxf(std::string_view bytes) {
  if (bytes.starts_with(kBinary)) return true;
  bytes = without_byte_order_mark(bytes);
  // Comments may stand first; then come a 0 and the first section.
  for (int i = 0; i < 64; ++i) {
    const std::size_t first = bytes.find('\n');
    if (first == std::string_view::npos) return false;
    const std::size_t second = std::min(bytes.find('\n', first + 1), bytes.size());
    const std::string_view code = trimmed(bytes.substr(0, first));
    const std::string_view value = trimmed(bytes.substr(first + 1, second - first - 1));
    if (code == "0") return value == "SECTION";
    if (code != "999") return false;
    bytes.remove_prefix(std::min(second + 1, bytes.size()));
  }
  return false;
}

Result<DxfScan> scan_dxf(std::string_view bytes) {
  if (bytes.starts_with(kBinary)) {
    return fail(ErrorCode::kUnsupportedModel,
                "this is a binary DXF file; save it as an ASCII DXF from the CAD program");
  }
  bytes = without_byte_order_mark(bytes);
  return Scanner(bytes).run();
}

}  // namespace symcell
