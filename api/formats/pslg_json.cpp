#include "api/formats/pslg_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell {
namespace {

constexpr std::size_t kMostDepth = 64;

// Walks over the text and leaves its position where the handler can see it.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char** position) : at_(at), position_(position) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    *position_ = ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  const char** position_;
};

enum class Field : std::uint8_t { kNone, kType, kVertices, kSegments, kHoles, kRegions, kIgnored };

enum class RegionKey : std::uint8_t { kNone, kPoint, kAttribute, kMaxArea };

// The state is the depth and the place in it:
//   depth 1: the model's object, `field_` tells the key
//   depth 2: the list of that field; depth 3: one entry (list, or object for a region)
//   depth 4: the "point" of a region
// The first error of structure is kept and reading goes on, looking only for what explains it
// better: "type": "plc", or a depth that no model has.
class PslgHandler {
 public:
  PslgHandler(std::string_view bytes, const char** position) : bytes_(bytes), position_(position) {}

  Result<Pslg> finish() {
    if (fatal_) return tl::unexpected(*fatal_);
    if (solid_) {
      return fail(
          ErrorCode::kUnsupportedModel,
          "this is a solid model (a PLC); only planar models (\"type\": \"pslg\") are meshed "
          "so far, solids come later",
          {}, "/type");
    }
    if (error_) return tl::unexpected(*error_);
    for (const auto& [field, name] :
         {std::pair{Field::kType, "type"}, std::pair{Field::kVertices, "vertices"},
          std::pair{Field::kSegments, "segments"}}) {
      if (seen(field)) continue;
      return fail(ErrorCode::kMissingField,
                  std::string("the model has no \"") + name +
                      "\"; a planar model is {\"type\": "
                      "\"pslg\", \"vertices\": [[x, y], ...], \"segments\": [[i, j], ...]}",
                  {}, std::string("/") + name);
    }
    return std::move(pslg_);
  }

  // --- Events of nlohmann's parser; false stops it. ---------------------------------------------
  bool null() {
    if (depth_ == 3 && field_ == Field::kRegions && region_key_ == RegionKey::kMaxArea) return true;
    return scalar("null");
  }
  bool boolean(bool value) { return scalar(value ? "true" : "false"); }
  bool number_integer(std::int64_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(std::uint64_t value) { return number(static_cast<double>(value)); }
  bool number_float(double value, const std::string&) { return number(value); }
  bool binary(std::vector<std::uint8_t>&) { return scalar("binary data"); }
  bool string(std::string& value) {
    if (depth_ == 1 && field_ == Field::kType) return type(value);
    return scalar("the string \"" + printable(value) + "\"");
  }
  bool start_object(std::size_t) {
    if (depth_ == 0) return deeper();
    if (!skipping() && depth_ == 2 && field_ == Field::kRegions) {
      begin_entry();
      region_ = {};
      region_seen_ = {};
      return deeper();
    }
    return container("an object");
  }
  bool start_array(std::size_t) {
    if (skipping()) return container("a list");
    if (depth_ == 1 && is_list(field_)) return deeper();
    if (depth_ == 2 && field_ != Field::kRegions) {
      begin_entry();
      return deeper();
    }
    if (depth_ == 3 && field_ == Field::kRegions && region_key_ == RegionKey::kPoint) {
      count_ = 0;
      return deeper();
    }
    return container("a list");
  }
  bool end_object() {
    leave();
    if (!skipping() && depth_ == 2 && field_ == Field::kRegions) return end_region();
    return true;
  }
  bool end_array() {
    leave();
    if (skipping()) return true;
    if (depth_ == 2 && field_ != Field::kRegions) return end_entry();
    if (depth_ == 3 && field_ == Field::kRegions) return end_region_point();
    return true;
  }
  bool key(std::string& name) {
    if (depth_ == 1) return model_key(name);
    if (!skipping() && depth_ == 3 && field_ == Field::kRegions) return region_key(name);
    return true;
  }
  bool parse_error(std::size_t position,
                   const std::string& last_token,
                   const nlohmann::detail::exception& exception) {
    const std::string at = " at byte " + std::to_string(position);
    constexpr int kNumberOverflow = 406;
    if (exception.id == kNumberOverflow) {
      fatal_ = Error{ErrorCode::kNonFinite,
                     "the number " + printable(last_token, 24) + at +
                         " overflows; coordinates are finite numbers",
                     {},
                     pointer()};
    } else if (const auto name = non_finite_name(position); !name.empty()) {
      fatal_ = Error{ErrorCode::kNonFinite,
                     std::string(name) + at + "; coordinates are finite numbers",
                     {},
                     pointer()};
    } else {
      const bool cut = position >= bytes_.size();
      fatal_ = Error{ErrorCode::kJsonSyntax,
                     "not well-formed JSON" + at + (cut ? ": the text ends too early" : "") +
                         " (last read: " + printable(last_token, 24) + ")",
                     {},
                     {}};
    }
    return false;
  }

 private:
  // --- Structure. -------------------------------------------------------------------------------
  static bool is_list(Field field) {
    return field == Field::kVertices || field == Field::kSegments || field == Field::kHoles ||
           field == Field::kRegions;
  }
  [[nodiscard]] bool seen(Field field) const { return seen_[static_cast<std::size_t>(field)]; }
  // Values of ignored keys and all that follows an error are only walked over.
  [[nodiscard]] bool skipping() const {
    return error_.has_value() || (field_ == Field::kIgnored && depth_ >= 1);
  }
  bool deeper() {
    if (++depth_ <= kMostDepth) return true;
    fatal_ = Error{ErrorCode::kJsonTooDeep,
                   "more than " + std::to_string(kMostDepth) + " nested lists or objects" +
                       where() + "; a model needs 4",
                   {},
                   {}};
    return false;
  }
  void leave() { --depth_; }

  bool container(const char* what) {
    if (!skipping()) wrong_type(what);
    return deeper();
  }
  bool scalar(const std::string& what) {
    if (!skipping()) wrong_type(what);
    return true;
  }

  bool type(const std::string& value) {
    if (value == "plc") {
      solid_ = true;
    } else if (value != "pslg") {
      complain(ErrorCode::kWrongType, "the type \"" + printable(value) +
                                          "\" is not known; a planar model is of type \"pslg\"");
    }
    return true;
  }

  bool model_key(const std::string& name) {
    static constexpr std::array kFields{
        std::pair{"type", Field::kType},         std::pair{"vertices", Field::kVertices},
        std::pair{"segments", Field::kSegments}, std::pair{"holes", Field::kHoles},
        std::pair{"regions", Field::kRegions},   std::pair{"name", Field::kIgnored},
        std::pair{"comment", Field::kIgnored},   std::pair{"units", Field::kIgnored}};
    const auto* found =
        std::ranges::find_if(kFields, [&](const auto& f) { return name == f.first; });
    if (found == kFields.end()) {
      if (name == "facets") solid_ = true;
      field_ = Field::kNone;
      complain(ErrorCode::kWrongType,
               "the key \"" + printable(name) +
                   "\" is not known; a planar model has type, vertices, segments, holes, regions "
                   "(and name, comment, units)");
      return true;
    }
    field_ = found->second;
    entry_ = 0;
    auto& seen = seen_[static_cast<std::size_t>(field_)];
    if (seen && field_ != Field::kIgnored) {
      complain(ErrorCode::kWrongType, "\"" + name + "\" is given twice");
    }
    seen = true;
    return true;
  }

  void begin_entry() {
    count_ = 0;
    region_key_ = RegionKey::kNone;
  }

  bool number(double value) {
    if (skipping()) return true;
    const bool in_entry = depth_ == 3 && field_ != Field::kRegions;
    const bool in_point = depth_ == 4;
    if (in_entry || in_point) {
      if (count_ < numbers_.size()) numbers_[count_] = value;
      ++count_;
      return true;
    }
    if (depth_ == 3 && region_key_ != RegionKey::kNone) return region_number(value);
    return scalar("the number " + std::to_string(value));
  }

  bool end_entry() {
    const bool segment = field_ == Field::kSegments;
    if (count_ != 2 && !(segment && count_ == 3)) {
      complain(ErrorCode::kWrongType, std::string(segment ? "a segment is [i, j] or [i, j, marker]"
                                                          : "a point is [x, y]") +
                                          "; here are " + std::to_string(count_) + " numbers");
      return true;
    }
    if (segment) {
      add_segment();
    } else {
      auto& points = field_ == Field::kVertices ? pslg_.vertices : pslg_.holes;
      points.push_back({numbers_[0], numbers_[1]});
    }
    return next_entry();
  }

  void add_segment() {
    PslgSegment segment;
    std::int32_t* const parts[] = {&segment.a, &segment.b, &segment.marker};
    for (std::size_t i = 0; i < count_; ++i) {
      const std::optional<std::int32_t> whole = whole_int32(numbers_[i]);
      if (whole) {
        *parts[i] = *whole;
        continue;
      }
      const std::string place = "/" + std::to_string(i);
      if (i < 2 && std::floor(numbers_[i]) == numbers_[i]) {
        return complain(ErrorCode::kIndexOutOfRange, "there is no vertex of this index", place);
      }
      return complain(
          ErrorCode::kWrongType,
          i < 2 ? "a vertex index is a whole number" : "a marker is a whole number of 32 bits",
          place);
    }
    pslg_.segments.push_back(segment);
  }

  bool next_entry() {
    count_ = 0;
    ++entry_;
    if (entry_ > (field_ == Field::kVertices ? kMaxPslgVertices : 4 * kMaxPslgVertices)) {
      fatal_ = Error{ErrorCode::kTooLarge,
                     "more than " + std::to_string(entry_ - 1) + " entries; split the model",
                     {},
                     pointer()};
      return false;
    }
    return true;
  }

  // --- Regions. ---------------------------------------------------------------------------------
  bool region_key(const std::string& name) {
    region_key_ = name == "point"       ? RegionKey::kPoint
                  : name == "attribute" ? RegionKey::kAttribute
                  : name == "max_area"  ? RegionKey::kMaxArea
                                        : RegionKey::kNone;
    if (region_key_ == RegionKey::kNone) {
      complain(ErrorCode::kWrongType,
               "the key \"" + printable(name) +
                   "\" is not known; a region has point, attribute, max_area");
      return true;
    }
    auto& seen = region_seen_[static_cast<std::size_t>(region_key_)];
    if (seen) complain(ErrorCode::kWrongType, "\"" + name + "\" is given twice");
    seen = true;
    return true;
  }

  bool region_number(double value) {
    if (region_key_ == RegionKey::kAttribute) {
      const std::optional<std::int32_t> whole = whole_int32(value);
      if (!whole) complain(ErrorCode::kWrongType, "an attribute is a whole number of 32 bits");
      region_.attribute = whole.value_or(0);
    } else if (region_key_ == RegionKey::kMaxArea) {
      if (!(value > 0)) {
        complain(ErrorCode::kWrongType, "max_area must be positive; leave it out for no bound");
      }
      region_.max_area = value;
    } else {
      wrong_type("a number");
    }
    return true;
  }

  bool end_region_point() {
    if (count_ != 2) {
      complain(ErrorCode::kWrongType,
               "a point is [x, y]; here are " + std::to_string(count_) + " numbers");
    }
    region_.point = {numbers_[0], numbers_[1]};
    count_ = 0;
    return true;
  }

  bool end_region() {
    region_key_ = RegionKey::kNone;
    if (!region_seen_[static_cast<std::size_t>(RegionKey::kPoint)]) {
      complain(ErrorCode::kMissingField,
               "the region has no \"point\": any point inside it, [x, y]");
      return true;
    }
    pslg_.regions.push_back(region_);
    return next_entry();
  }

  // --- Messages. --------------------------------------------------------------------------------
  [[nodiscard]] std::string where() const {
    return " near byte " + std::to_string(*position_ - bytes_.data());
  }

  // Where reading stands, as RFC 6901 has it.
  [[nodiscard]] std::string pointer() const {
    static constexpr std::array kNames{"",       "/type",    "/vertices", "/segments",
                                       "/holes", "/regions", ""};
    std::string text = depth_ == 0 ? "" : kNames[static_cast<std::size_t>(field_)];
    if (depth_ < 2 || text.empty()) return text;
    text += "/" + std::to_string(entry_);
    if (field_ != Field::kRegions) {
      if (depth_ > 2) text += "/" + std::to_string(count_);
      return text;
    }
    static constexpr std::array kRegionNames{"", "/point", "/attribute", "/max_area"};
    if (depth_ > 2) text += kRegionNames[static_cast<std::size_t>(region_key_)];
    if (depth_ > 3) text += "/" + std::to_string(count_);
    return text;
  }

  // `place` continues the pointer.
  void complain(ErrorCode code, const std::string& what, const std::string& place = {}) {
    if (error_) return;
    const std::string at = pointer() + place;
    error_ = Error{code, (at.empty() ? "" : at + ": ") + what + where(), {}, at};
  }

  void wrong_type(const std::string& what) {
    const char* wanted = "an object with type, vertices, segments";
    if (depth_ == 1) wanted = field_ == Field::kType ? "the string \"pslg\"" : "a list";
    if (depth_ == 2) {
      wanted = field_ == Field::kRegions    ? "an object {\"point\": [x, y], ...}"
               : field_ == Field::kSegments ? "[i, j] or [i, j, marker]"
                                            : "[x, y]";
    }
    if (depth_ >= 3) wanted = "a number";
    if (depth_ == 3 && region_key_ == RegionKey::kPoint) wanted = "[x, y]";
    complain(ErrorCode::kWrongType, std::string(wanted) + " belongs here, not " + what);
  }

  // NaN and its like are no JSON; the name of the one that stands at the error, or nothing.
  [[nodiscard]] std::string_view non_finite_name(std::size_t position) const {
    const std::size_t begin = position > 12 ? position - 12 : 0;
    const std::string_view around = bytes_.substr(begin, 24);
    const std::size_t offset = position - begin;
    for (const std::string_view name : {"NaN", "nan", "Infinity", "inf", "Inf"}) {
      const std::size_t at = around.find(name);
      // The error is told one or more letters into the token.
      if (at != std::string_view::npos && at < offset && offset <= at + name.size()) return name;
    }
    return {};
  }

  std::string_view bytes_;
  const char** position_;
  Pslg pslg_;
  std::optional<Error> error_;  // the first error of structure
  std::optional<Error> fatal_;  // one that ended the reading
  bool solid_ = false;

  std::size_t depth_ = 0;
  Field field_ = Field::kNone;
  std::array<bool, 7> seen_{};
  std::size_t entry_ = 0;  // index in the field's list
  std::size_t count_ = 0;  // numbers of the entry so far
  std::array<double, 3> numbers_{};
  RegionKey region_key_ = RegionKey::kNone;
  std::array<bool, 4> region_seen_{};
  PslgRegion region_;
};

}  // namespace

Result<Pslg> read_pslg_json(std::string_view bytes) {
  const char* position = bytes.data();
  PslgHandler handler(bytes, &position);
  nlohmann::json::sax_parse(CountingIterator(bytes.data(), &position),
                            CountingIterator(bytes.data() + bytes.size(), &position), &handler);
  return handler.finish();
}

}  // namespace symcell
