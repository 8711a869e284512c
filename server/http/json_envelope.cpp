#include "server/http/json_envelope.hpp"

#include <optional>
#include <string>

#include "api/formats/byte_order_mark.hpp"

namespace symcell::server {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

class Scanner {
 public:
  explicit Scanner(std::string_view text)
      : text_(text), at_(text.size() - without_byte_order_mark(text).size()) {}

  [[nodiscard]] std::size_t position() const { return at_; }
  [[nodiscard]] bool at_end() const { return at_ == text_.size(); }
  [[nodiscard]] char peek() const { return at_end() ? '\0' : text_[at_]; }

  void skip_space() {
    while (!at_end() && is_space(text_[at_])) ++at_;
  }

  bool take(char c) {
    skip_space();
    if (peek() != c || at_end()) return false;
    ++at_;
    return true;
  }

  // A string with its quotes; nullopt: none here, or it does not end.
  std::optional<std::string_view> take_string() {
    skip_space();
    const std::size_t begin = at_;
    if (peek() != '"') return std::nullopt;
    for (++at_; !at_end(); ++at_) {
      if (text_[at_] == '\\') {
        if (++at_ == text_.size()) return std::nullopt;
      } else if (text_[at_] == '"') {
        ++at_;
        return text_.substr(begin, at_ - begin);
      }
    }
    return std::nullopt;
  }

  // Any value, by the balance of its brackets; nullopt: it does not end.
  std::optional<std::string_view> take_value() {
    skip_space();
    const std::size_t begin = at_;
    std::size_t depth = 0;
    while (!at_end()) {
      const char c = text_[at_];
      if (c == '"') {
        if (!take_string()) return std::nullopt;
        if (depth == 0) break;
        continue;
      }
      if (c == '{' || c == '[') ++depth;
      if (c == '}' || c == ']') {
        if (depth == 0) break;
        if (--depth == 0) {
          ++at_;
          break;
        }
      }
      if (depth == 0 && (c == ',' || is_space(c))) break;
      ++at_;
    }
    if (depth != 0 || at_ == begin) return std::nullopt;
    return text_.substr(begin, at_ - begin);
  }

 private:
  std::string_view text_;
  std::size_t at_;
};

Failure syntax_error(std::size_t position, const std::string& expected) {
  return fail(ErrorCode::kJsonSyntax, "the body is not well-formed JSON at byte " +
                                          std::to_string(position) + ": " + expected + " expected");
}

struct Members {
  std::optional<std::string_view> model;
  std::optional<std::string_view> options;
  bool has_type = false;
  std::string unknown;  // first name that is neither
};

Result<void> note_member(Members& members, std::string_view name, std::string_view value) {
  if (name == "\"model\"" || name == "\"options\"") {
    auto& member = name == "\"model\"" ? members.model : members.options;
    if (member) {
      return fail(ErrorCode::kJsonSyntax, "the body has " + std::string(name) + " twice");
    }
    member = value;
    return {};
  }
  if (name == "\"type\"") members.has_type = true;
  if (members.unknown.empty()) members.unknown = name.substr(1, name.size() - 2);
  return {};
}

Result<Members> scan_members(Scanner& scanner) {
  Members members;
  if (scanner.take('}')) return members;
  while (true) {
    const auto name = scanner.take_string();
    if (!name) return syntax_error(scanner.position(), "a name in quotes");
    if (!scanner.take(':')) return syntax_error(scanner.position(), "':'");
    const auto value = scanner.take_value();
    if (!value) return syntax_error(scanner.position(), "a complete value");
    SYMCELL_TRY(note_member(members, *name, *value));
    if (scanner.take('}')) return members;
    if (!scanner.take(',')) return syntax_error(scanner.position(), "',' or '}'");
  }
}

}  // namespace

Result<EnvelopeParts> split_envelope(std::string_view body) {
  Scanner scanner(body);
  scanner.skip_space();
  if (scanner.at_end()) {
    return fail(ErrorCode::kEmptyFile,
                "the body is empty; send {\"model\": ..., \"options\": {...}}");
  }
  if (!scanner.take('{')) {
    const char first = scanner.peek();
    if (first != '[' && first != '"') return syntax_error(scanner.position(), "'{'");
    return fail(ErrorCode::kWrongType, "the body must be an object with \"model\" in it");
  }
  const auto members = scan_members(scanner);
  if (!members) return error_of(members);
  scanner.skip_space();
  if (!scanner.at_end()) return syntax_error(scanner.position(), "the end of the body");

  if (!members->model) {
    if (members->has_type && !members->options) return EnvelopeParts{body, {}, true};
    return fail(ErrorCode::kMissingField, "the body has no \"model\"", {}, "/model");
  }
  if (!members->unknown.empty()) {
    return fail(ErrorCode::kBadOption,
                "the body has an unknown member \"" + members->unknown +
                    "\"; options belong into \"options\"",
                {}, "/" + members->unknown);
  }
  return EnvelopeParts{*members->model, members->options.value_or(std::string_view{}), false};
}

}  // namespace symcell::server
