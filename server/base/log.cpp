#include "server/base/log.hpp"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

#include "server/base/clock.hpp"

namespace symcell::server {
namespace {

spdlog::level::level_enum to_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug: return spdlog::level::debug;
    case LogLevel::kInfo: return spdlog::level::info;
    case LogLevel::kWarning: return spdlog::level::warn;
    case LogLevel::kError: return spdlog::level::err;
    case LogLevel::kOff: return spdlog::level::off;
  }
  return spdlog::level::info;
}

std::string_view level_name(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug: return "debug";
    case LogLevel::kInfo: return "info";
    case LogLevel::kWarning: return "warning";
    case LogLevel::kError: return "error";
    case LogLevel::kOff: return "off";
  }
  return "info";
}

nlohmann::ordered_json to_json(const LogField& field) {
  return std::visit([](const auto& value) { return nlohmann::ordered_json(value); }, field.value);
}

// Invalid UTF-8 (a path may hold any byte) is replaced, never an exception.
std::string dump(const nlohmann::ordered_json& value) {
  return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string json_line(LogLevel level,
                      std::string_view event,
                      std::initializer_list<LogField> fields) {
  nlohmann::ordered_json line;
  line["time"] = format_timestamp(now_ms());
  line["level"] = level_name(level);
  line["event"] = event;
  for (const LogField& field : fields) line[std::string(field.key)] = to_json(field);
  return dump(line);
}

std::string text_line(LogLevel level,
                      std::string_view event,
                      std::initializer_list<LogField> fields) {
  std::string line = format_timestamp(now_ms());
  line.append(" ").append(level_name(level)).append(" ").append(event);
  for (const LogField& field : fields) {
    line.append(" ").append(field.key).append("=").append(dump(to_json(field)));
  }
  return line;
}

}  // namespace

std::optional<LogLevel> log_level_from_name(std::string_view name) {
  for (const LogLevel level :
       {LogLevel::kDebug, LogLevel::kInfo, LogLevel::kWarning, LogLevel::kError, LogLevel::kOff}) {
    if (level_name(level) == name) return level;
  }
  return std::nullopt;
}

struct Logger::Impl {
  spdlog::logger logger{"symcell", std::make_shared<spdlog::sinks::stderr_sink_mt>()};
};

Logger::Logger(LogLevel level, LogFormat format)
    : impl_(std::make_unique<Impl>()), format_(format) {
  impl_->logger.set_pattern("%v");
  impl_->logger.set_level(to_spdlog(level));
  impl_->logger.flush_on(spdlog::level::info);
}

Logger::~Logger() = default;

void Logger::log(LogLevel level,
                 std::string_view event,
                 std::initializer_list<LogField> fields) noexcept {
  try {
    const auto spdlog_level = to_spdlog(level);
    if (!impl_->logger.should_log(spdlog_level)) return;
    impl_->logger.log(spdlog_level, "{}",
                      format_ == LogFormat::kJson ? json_line(level, event, fields)
                                                  : text_line(level, event, fields));
  } catch (...) {
    // Out of memory while logging: losing the line is better than losing the server.
  }
}

}  // namespace symcell::server
