#include "api/formats/json_walker.hpp"

#include <iterator>

#include "api/printable.hpp"

namespace symcell::internal {
namespace {

constexpr JsonPlace kIgnoredPlace{0, JsonShape::kIgnored, ""};

// Walks over the text and leaves its position where the walker can see it.
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

}  // namespace

Result<void> JsonWalker::walk() {
  nlohmann::json::sax_parse(CountingIterator(bytes_.data(), &position_),
                            CountingIterator(bytes_.data() + bytes_.size(), &position_), this);
  if (fatal_) return fail(*fatal_);
  if (error_) return fail(*error_);
  return {};
}

bool JsonWalker::null() {
  if (expected().shape != JsonShape::kNumberOrNull) return misplaced("null");
  next();
  return true;
}

bool JsonWalker::string(std::string& value) {
  const JsonPlace& place = expected();
  if (place.shape != JsonShape::kText) return misplaced("the string \"" + printable(value) + "\"");
  text(place, value);
  next();
  return !fatal_;
}

bool JsonWalker::take_number(double value) {
  const JsonPlace& place = expected();
  if (place.shape != JsonShape::kNumber && place.shape != JsonShape::kNumberOrNull) {
    return misplaced("the number " + std::to_string(value));
  }
  number(place, value);
  next();
  return !fatal_;
}

bool JsonWalker::key(std::string& name) {
  Frame& frame = frames_.back();
  frame.pending = &kIgnoredPlace;
  frame.key = {};
  if (error_ || frame.place->shape == JsonShape::kIgnored) return true;
  const JsonPlace* found = member(*frame.place, name);
  if (found == nullptr) {
    complain(ErrorCode::kWrongType,
             "the key \"" + printable(name) + "\" is not known; " + keys_of(*frame.place));
    return true;
  }
  // Readers' places nest less deeply than keys_ is long.
  keys_[frames_.size() - 1] = name;
  frame.key = keys_[frames_.size() - 1];
  frame.pending = found;
  if (found->shape == JsonShape::kIgnored) return true;
  const std::uint32_t bit = std::uint32_t{1} << found->id;
  if ((frame.seen & bit) != 0) {
    complain(ErrorCode::kWrongType, "\"" + name + "\" is given twice");
  }
  frame.seen |= bit;
  return true;
}

const JsonPlace& JsonWalker::expected() const {
  if (error_) return kIgnoredPlace;
  if (frames_.empty()) return root();
  const Frame& frame = frames_.back();
  switch (frame.place->shape) {
    case JsonShape::kObject: return *frame.pending;
    case JsonShape::kList: return item(*frame.place);
    default: return kIgnoredPlace;
  }
}

bool JsonWalker::open(JsonShape shape, const char* what) {
  const JsonPlace* place = &expected();
  if (place->shape != JsonShape::kIgnored && place->shape != shape) {
    const JsonPlace* other = other_shape(*place, shape);
    if (other == nullptr) misplaced(what);
    place = other != nullptr ? other : &kIgnoredPlace;
  }
  if (frames_.size() == kMostJsonDepth) {
    fatal_ = Error{ErrorCode::kJsonTooDeep,
                   "more than " + std::to_string(kMostJsonDepth) + " nested lists or objects" +
                       where() + "; no model needs that",
                   {},
                   {}};
    return false;
  }
  frames_.push_back({.place = place, .key = {}});
  if (place->shape != JsonShape::kIgnored) begin(*place);
  return !fatal_;
}

bool JsonWalker::close() {
  const Frame frame = frames_.back();
  frames_.pop_back();
  if (!error_ && frame.place->shape != JsonShape::kIgnored) end(*frame.place, frame.seen);
  next();
  return !fatal_;
}

// A value is complete.
void JsonWalker::next() {
  if (frames_.empty()) return;
  ++frames_.back().index;
  frames_.back().key = {};
}

bool JsonWalker::misplaced(const std::string& what) {
  if (!skipping()) {
    complain(ErrorCode::kWrongType, std::string(expected().wanted) + " belongs here, not " + what);
  }
  return true;
}

void JsonWalker::complain(ErrorCode code, const std::string& what, const std::string& place) {
  if (error_) return;
  const std::string at = pointer() + place;
  error_ = Error{code, (at.empty() ? "" : at + ": ") + what + where(), {}, at};
}

void JsonWalker::stop(ErrorCode code, const std::string& what) {
  if (!fatal_) fatal_ = Error{code, what + where(), {}, pointer()};
}

std::string JsonWalker::where() const {
  return " near byte " + std::to_string(position_ - bytes_.data());
}

// Where reading stands, as RFC 6901 has it.
std::string JsonWalker::pointer() const {
  std::string text;
  for (const Frame& frame : frames_) {
    const bool list = frame.place->shape == JsonShape::kList;
    if (!list && frame.key.empty()) return text;
    text += "/";
    text += list ? std::to_string(frame.index) : std::string(frame.key);
  }
  return text;
}

bool JsonWalker::parse_error(std::size_t position,
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

// NaN and its like are no JSON; the name of the one that stands at the error, or nothing.
std::string_view JsonWalker::non_finite_name(std::size_t position) const {
  const std::size_t begin = position > 12 ? position - 12 : 0;
  const std::string_view around = bytes_.substr(begin, 24);
  const std::size_t offset = position - begin;
  for (const std::string_view name : {"NaN", "nan", "Infinity", "inf", "Inf"}) {
    const std::size_t at = around.find(name);
    // The error is reported one or more letters into the token.
    if (at != std::string_view::npos && at < offset && offset <= at + name.size()) return name;
  }
  return {};
}

}  // namespace symcell::internal
