#include "api/formats/fem.hpp"

#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "api/formats/byte_order_mark.hpp"
#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"
#include "core/geometry/arc.hpp"

namespace symcell {
namespace {

constexpr std::size_t kMostNumbers = 8;               // of a line that matter
constexpr double kWidestArc = 360;                    // degrees, not reached
constexpr double kLeastStep = 1e-3, kMostStep = 180;  // degrees of an arc's chord

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

class FemReader {
 public:
  explicit FemReader(std::string_view bytes) : rest_(bytes) {}

  Result<Pslg> read() {
    while (next_line()) {
      const std::string key = key_of_line();
      if (key == "[solution]") break;  // of an .ans file
      if (key == "<bdryname>") names_.emplace_back(unquoted(value_of_line()));
      Result<void> done;
      if (key == "[numpoints]") done = list("point", 2, [&] { return add_point(); });
      if (key == "[numsegments]") done = list("segment", 2, [&] { return add_segment(); });
      if (key == "[numarcsegments]") done = list("arc", 3, [&] { return add_arc(); });
      if (key == "[numholes]") done = list("hole", 2, [&] { return add_hole(); });
      if (key == "[numblocklabels]") done = list("block label", 2, [&] { return add_label(); });
      if (!done) return error_of(done);
    }
    if (!seen_points_) {
      return fail(ErrorCode::kTruncated, "the file has no [NumPoints]; was it written completely?");
    }
    SYMCELL_TRY(check_ends());
    finish();
    return std::move(pslg_);
  }

 private:
  struct Label {
    PslgRegion region;
    std::int32_t material = 0;
    std::int32_t group = 0;
  };

  bool next_line() {
    if (rest_.empty()) return false;
    ++number_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = trimmed(rest_.substr(0, end));
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return true;
  }

  [[nodiscard]] std::string key_of_line() const {
    return lower(trimmed(line_.substr(0, line_.find('='))));
  }
  [[nodiscard]] std::string_view value_of_line() const {
    const std::size_t equals = line_.find('=');
    return equals == std::string_view::npos ? std::string_view()
                                            : trimmed(line_.substr(equals + 1));
  }
  static std::string unquoted(std::string_view text) {
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
      text = text.substr(1, text.size() - 2);
    }
    std::string name(text);
    for (char& c : name) c = static_cast<unsigned char>(c) < ' ' ? '?' : c;
    return name;
  }

  [[nodiscard]] Failure complain(ErrorCode code, const std::string& what) const {
    return fail(code, "line " + std::to_string(number_) + ": " + what);
  }

  // The numbers that a line begins with, up to kMostNumbers.
  Result<void> read_numbers(const std::string& name, std::size_t least) {
    count_ = 0;
    std::string_view rest = line_;
    while (count_ < kMostNumbers) {
      const std::size_t begin = rest.find_first_not_of(" \t,");
      if (begin == std::string_view::npos) break;
      rest.remove_prefix(begin);
      const std::size_t end = std::min(rest.find_first_of(" \t,"), rest.size());
      const std::string_view token = rest.substr(0, end);
      rest.remove_prefix(end);
      const ParsedNumber number = parse_number(token);
      if (number.kind == NumberKind::kNonFinite) {
        return complain(ErrorCode::kNonFinite,
                        "\"" + printable(token, 24) + "\" of the " + name + " is no finite number");
      }
      if (number.kind == NumberKind::kNoNumber) {
        if (count_ >= least) break;
        return complain(ErrorCode::kSyntax,
                        "\"" + printable(token, 24) + "\" of the " + name + " is no number");
      }
      numbers_[count_++] = number.value;
    }
    if (count_ < least) {
      return complain(ErrorCode::kSyntax, "the " + name + " needs " + std::to_string(least) +
                                              " numbers and has " + std::to_string(count_));
    }
    return {};
  }

  template <class Add>
  Result<void> list(const char* what, std::size_t least, const Add& add) {
    const auto count = parse_integer(value_of_line());
    if (!count || *count < 0) {
      return complain(ErrorCode::kSyntax,
                      "\"" + printable(value_of_line(), 24) + "\" is no number of " + what + "s");
    }
    if (static_cast<std::size_t>(*count) > kMaxPslgVertices) {
      return complain(ErrorCode::kTooLarge, std::to_string(*count) + " " + what +
                                                "s are more than " +
                                                std::to_string(kMaxPslgVertices));
    }
    seen_points_ = seen_points_ || std::string_view(what) == "point";
    for (std::int64_t i = 0; i < *count; ++i) {
      const std::string name = std::string(what) + " " + std::to_string(i);
      if (!next_line()) {
        return complain(ErrorCode::kTruncated,
                        "the file ends before the " + name + " of " + std::to_string(*count));
      }
      if (line_.starts_with('[') || line_.starts_with('<')) {
        return complain(ErrorCode::kCountMismatch,
                        "the " + name + " of " + std::to_string(*count) + " should stand here");
      }
      SYMCELL_TRY(read_numbers(name, least));
      name_ = name;
      SYMCELL_TRY(add());
    }
    return {};
  }

  [[nodiscard]] double value(std::size_t i) const { return i < count_ ? numbers_[i] : 0; }

  [[nodiscard]] Result<std::int32_t> whole(std::size_t i) const {
    const auto number = whole_int32(value(i));
    if (number) return *number;
    return complain(ErrorCode::kSyntax,
                    "number " + std::to_string(i + 1) + " of the " + name_ + " is no whole number");
  }

  Result<void> add_point() {
    pslg_.vertices.push_back({value(0), value(1)});
    return {};
  }

  Result<void> push(std::size_t boundary, double bulge, double step) {
    PslgSegment segment;
    for (const auto& [i, target] :
         {std::pair(std::size_t{0}, &segment.a), {1, &segment.b}, {boundary, &segment.marker}}) {
      const auto number = whole(i);
      if (!number) return error_of(number);
      *target = *number;
    }
    pslg_.segments.push_back(segment);
    pslg_.bulges.push_back(bulge);
    pslg_.chord_angles.push_back(step);
    lines_.push_back(number_);
    return {};
  }

  // Ends, largest side, boundary property, hidden, group.
  Result<void> add_segment() { return push(3, 0, 0); }

  // Ends, angle, largest angle of a chord, boundary property, hidden, group.
  Result<void> add_arc() {
    const double angle = value(2), step = value(3);
    if (!(angle > 0 && angle < kWidestArc)) {
      return complain(ErrorCode::kSyntax, "the " + name_ + " turns by " + std::to_string(angle) +
                                              " degrees; above 0 and below 360 are possible");
    }
    if (count_ > 3 && !(step >= kLeastStep && step <= kMostStep)) {
      return complain(ErrorCode::kSyntax, "chords of " + std::to_string(step) + " degrees of the " +
                                              name_ + "; 0.001 to 180 are possible");
    }
    constexpr double kRadians = std::numbers::pi / 180;
    return push(4, bulge_of_angle(kRadians * angle), kRadians * step);
  }

  Result<void> add_hole() {
    pslg_.holes.push_back({value(0), value(1)});
    return {};
  }

  // Place, material, mesh size, circuit, direction of magnetisation, group.
  Result<void> add_label() {
    Label label;
    label.region.point = {value(0), value(1)};
    for (const auto& [i, target] :
         {std::pair(std::size_t{2}, &label.material), {6, &label.group}}) {
      const auto number = whole(i);
      if (!number) return error_of(number);
      *target = *number;
    }
    const double size = value(3);
    if (size > 0) label.region.max_area = std::numbers::pi / 4 * size * size;
    labels_.push_back(label);
    return {};
  }

  [[nodiscard]] Result<void> check_ends() const {
    const auto count = static_cast<std::int64_t>(pslg_.vertices.size());
    for (std::size_t s = 0; s < pslg_.segments.size(); ++s) {
      for (const std::int32_t v : {pslg_.segments[s].a, pslg_.segments[s].b}) {
        if (v >= 0 && v < count) continue;
        return fail(ErrorCode::kIndexOutOfRange, "line " + std::to_string(lines_[s]) +
                                                     ": there is no point " + std::to_string(v) +
                                                     "; the file has " + std::to_string(count));
      }
    }
    return {};
  }

  void finish() {
    bool grouped = false;
    for (const Label& label : labels_) grouped = grouped || label.group != 0;
    for (Label& label : labels_) {
      label.region.attribute = grouped ? label.group : label.material;
      pslg_.regions.push_back(label.region);
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      pslg_.marker_names.push_back({static_cast<std::int32_t>(i + 1), names_[i]});
    }
    if (!pslg_.has_arcs()) {
      pslg_.bulges.clear();
      pslg_.chord_angles.clear();
    }
  }

  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
  std::array<double, kMostNumbers> numbers_{};
  std::size_t count_ = 0;
  std::string name_;  // of the entity that is read
  bool seen_points_ = false;
  std::vector<std::string> names_;  // of boundary properties
  std::vector<Label> labels_;
  std::vector<std::size_t> lines_;  // per segment
  Pslg pslg_;
};

}  // namespace

bool looks_like_fem(std::string_view bytes) {
  bytes = without_byte_order_mark(bytes);
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return false;
  return lower(bytes.substr(begin, 8)) == "[format]";
}

Result<Pslg> read_fem(std::string_view bytes) {
  return FemReader(bytes).read();
}

}  // namespace symcell
