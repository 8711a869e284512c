// Structured log events, one line each, as JSON or as text: a name and typed fields.
//
// Any thread may log. What is written never contains request bodies or header values other than the
// request id, so logs hold no user data beyond paths.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace symcell::server {

enum class LogLevel : std::uint8_t { kDebug, kInfo, kWarning, kError, kOff };
enum class LogFormat : std::uint8_t { kText, kJson };

[[nodiscard]] std::optional<LogLevel> log_level_from_name(std::string_view name);

struct LogField {
  std::string_view key;
  std::variant<std::string_view, std::int64_t, double, bool> value;
};

class Logger {
 public:
  // Lines go to standard error.
  Logger(LogLevel level, LogFormat format);
  ~Logger();
  Logger(const Logger&) = delete;
  Logger& operator=(const Logger&) = delete;

  // `event`: snake_case name of what happened, the same for every occurrence.
  void log(LogLevel level,
           std::string_view event,
           std::initializer_list<LogField> fields = {}) noexcept;

  void debug(std::string_view event, std::initializer_list<LogField> fields = {}) noexcept {
    log(LogLevel::kDebug, event, fields);
  }
  void info(std::string_view event, std::initializer_list<LogField> fields = {}) noexcept {
    log(LogLevel::kInfo, event, fields);
  }
  void warning(std::string_view event, std::initializer_list<LogField> fields = {}) noexcept {
    log(LogLevel::kWarning, event, fields);
  }
  void error(std::string_view event, std::initializer_list<LogField> fields = {}) noexcept {
    log(LogLevel::kError, event, fields);
  }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  LogFormat format_;
};

}  // namespace symcell::server
