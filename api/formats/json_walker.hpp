// Model JSON as events: walks the text place by place, holds what every kind of model shares
// (nesting, the first error with its JSON pointer and byte) and leaves to the reader of a kind what
// its places mean. No tree: memory is that of the result.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace symcell::internal {

// Lists and objects within one another; no model needs more than a few.
inline constexpr std::size_t kMostJsonDepth = 64;

enum class JsonShape : std::uint8_t { kObject, kList, kNumber, kNumberOrNull, kText, kIgnored };

// What belongs at a place of a model's JSON. Ids are the reader's own, below 32.
struct JsonPlace {
  std::uint8_t id;
  JsonShape shape;
  const char* wanted;  // in words, for "... belongs here, not ..."
};

// Whether a member of an object was there; `seen` as the walker reports it: a bit a place's id.
[[nodiscard]] inline bool has(std::uint32_t seen, const JsonPlace& place) {
  return (seen >> place.id & 1U) != 0;
}

class JsonWalker {
 public:
  explicit JsonWalker(std::string_view bytes) : bytes_(bytes), position_(bytes.data()) {}
  JsonWalker(const JsonWalker&) = delete;
  JsonWalker& operator=(const JsonWalker&) = delete;
  virtual ~JsonWalker() = default;

  // Walks over all of the text. The first error of structure is kept and reading goes on, looking
  // only for what is worse: no JSON at all, or a depth that no model has.
  // Errors: kJsonSyntax, kJsonTooDeep, kNonFinite, and those of the reader.
  [[nodiscard]] Result<void> walk();

  // --- Events of nlohmann's parser; false stops it. ---------------------------------------------
  bool null();
  bool boolean(bool value) { return misplaced(value ? "true" : "false"); }
  bool number_integer(std::int64_t value) { return take_number(static_cast<double>(value)); }
  bool number_unsigned(std::uint64_t value) { return take_number(static_cast<double>(value)); }
  bool number_float(double value, const std::string& /*text*/) { return take_number(value); }
  bool binary(std::vector<std::uint8_t>& /*data*/) { return misplaced("binary data"); }
  bool string(std::string& value);
  bool start_object(std::size_t /*count*/) { return open(JsonShape::kObject, "an object"); }
  bool start_array(std::size_t /*count*/) { return open(JsonShape::kList, "a list"); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name);
  bool parse_error(std::size_t position,
                   const std::string& last_token,
                   const nlohmann::detail::exception& exception);

 protected:
  // --- What a reader defines. -------------------------------------------------------------------
  [[nodiscard]] virtual const JsonPlace& root() const = 0;
  // The place of a key's value; nullptr: the object has no such key.
  [[nodiscard]] virtual const JsonPlace* member(const JsonPlace& object,
                                                std::string_view key) const = 0;
  [[nodiscard]] virtual const JsonPlace& item(const JsonPlace& list) const = 0;
  // What stands at a place in the other shape, where both a list and an object may; nullptr: nothing.
  [[nodiscard]] virtual const JsonPlace* other_shape(const JsonPlace& /*place*/,
                                                     JsonShape /*shape*/) const {
    return nullptr;
  }
  // The keys of an object, for the message about one that it has not.
  [[nodiscard]] virtual const char* keys_of(const JsonPlace& object) const = 0;
  virtual void begin(const JsonPlace& /*place*/) {}
  // `seen`: bits of the ids of the members of an object.
  virtual void end(const JsonPlace& place, std::uint32_t seen) = 0;
  virtual void number(const JsonPlace& place, double value) = 0;
  virtual void text(const JsonPlace& /*place*/, const std::string& /*value*/) {}

  // Keeps the first error; `place` continues the pointer of where reading stands.
  void complain(ErrorCode code, const std::string& what, const std::string& place = {});
  // Ends the reading.
  void stop(ErrorCode code, const std::string& what);

 private:
  struct Frame {
    const JsonPlace* place;
    const JsonPlace* pending = nullptr;  // objects: of the key read last
    std::string_view key;                // its name, in the reader's static storage or empty
    std::size_t index = 0;               // lists: items so far
    std::uint32_t seen = 0;
  };

  [[nodiscard]] const JsonPlace& expected() const;
  [[nodiscard]] bool skipping() const { return expected().shape == JsonShape::kIgnored; }
  [[nodiscard]] std::string where() const;
  [[nodiscard]] std::string pointer() const;
  [[nodiscard]] std::string_view non_finite_name(std::size_t position) const;
  bool open(JsonShape shape, const char* what);
  bool close();
  bool take_number(double value);
  bool misplaced(const std::string& what);
  void next();

  std::string_view bytes_;
  const char* position_;
  std::vector<Frame> frames_;
  std::array<std::string, 8> keys_;  // names of pending keys by depth; deeper ones are ignored
  std::optional<Error> error_;       // the first error of structure
  std::optional<Error> fatal_;       // one that ended the reading
};

// x, y and perhaps z of a point while it is read.
struct JsonNumbers {
  std::array<double, 3> values{};
  std::size_t count = 0;  // all that stand there, also beyond three
  void add(double value) {
    if (count < values.size()) values[count] = value;
    ++count;
  }
};

}  // namespace symcell::internal
