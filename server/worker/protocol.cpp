#include "server/worker/protocol.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

#include "api/formats/model_format.hpp"
#include "api/schema/options.hpp"

namespace symcell::server {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLengthBytes = 4;
constexpr char kEscape = '%';

// A file name is bytes, JSON is UTF-8: bytes beyond ASCII travel as %XX.
std::string path_to_text(const std::filesystem::path& path) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const char c : path.native()) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && c != kEscape) {
      text.push_back(c);
      continue;
    }
    text.push_back(kEscape);
    text.push_back(kDigits[byte >> 4U]);
    text.push_back(kDigits[byte & 0xFU]);
  }
  return text;
}

std::filesystem::path path_from_text(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != kEscape || i + 2 >= text.size()) {
      bytes.push_back(text[i]);
      continue;
    }
    bytes.push_back(static_cast<char>(std::strtoul(text.substr(i + 1, 2).c_str(), nullptr, 16)));
    i += 2;
  }
  return bytes;
}

Json begin(std::string_view type) {
  return {{"v", kWorkerProtocolVersion}, {"type", type}};
}

Json to_json(const HelloMessage&) {
  return begin("hello");
}

Json to_json(const RequestMessage& request) {
  Json json = begin("request");
  json["task"] = static_cast<int>(request.task);
  json["model"] = path_to_text(request.job.model);
  json["model_format"] = static_cast<int>(request.job.model_format);
  json["format_is_known"] = request.format_is_known;
  json["options"] =
      options_to_json(request.job.options, model_format_info(request.job.model_format).kind);
  json["cell"] = path_to_text(request.job.cell);
  json["statistics"] = path_to_text(request.job.statistics);
  json["memory_bytes"] = request.limits.memory_bytes;
  json["cpu_seconds"] = request.limits.cpu_seconds;
  json["file_bytes"] = request.limits.file_bytes;
  return json;
}

Json to_json(const CancelMessage&) {
  return begin("cancel");
}

Json to_json(const ProgressMessage& message) {
  Json json = begin("progress");
  json["phase"] = static_cast<int>(message.progress.phase);
  json["fraction"] = message.progress.fraction;
  json["elements"] = message.progress.elements;
  json["quality"] = message.progress.quality_reached;
  return json;
}

Json to_json(const DoneMessage& message) {
  Json json = begin("done");
  json["document"] = message.document;
  return json;
}

Json to_json(const FailedMessage& message) {
  Json json = begin("failed");
  json["code"] = static_cast<int>(message.error.code);
  json["message"] = message.error.message;
  json["elements"] = message.error.elements;
  json["pointer"] = message.error.pointer;
  return json;
}

Result<WorkerMessage> request_from_json(const nlohmann::json& json) {
  const auto options = options_from_json(json.at("options"));
  if (!options) return error_of(options);
  RequestMessage request;
  request.task = static_cast<WorkerTask>(json.at("task").get<int>());
  request.job.model = path_from_text(json.at("model"));
  request.job.model_format = static_cast<ModelFormat>(json.at("model_format").get<int>());
  request.format_is_known = json.at("format_is_known");
  request.job.options = *options;
  request.job.cell = path_from_text(json.at("cell"));
  request.job.statistics = path_from_text(json.at("statistics"));
  request.limits = {json.at("memory_bytes"), json.at("cpu_seconds"), json.at("file_bytes")};
  return request;
}

Result<WorkerMessage> message_from_json(const nlohmann::json& json) {
  if (json.at("v") != kWorkerProtocolVersion) {
    return fail(ErrorCode::kInternal, "the other end speaks another version of the protocol");
  }
  const std::string type = json.at("type");
  if (type == "hello") return HelloMessage{};
  if (type == "request") return request_from_json(json);
  if (type == "cancel") return CancelMessage{};
  if (type == "progress") {
    return ProgressMessage{{static_cast<Phase>(json.at("phase").get<int>()), json.at("fraction"),
                            json.at("elements"), json.at("quality")}};
  }
  if (type == "done") return DoneMessage{json.at("document")};
  if (type == "failed") {
    return FailedMessage{Error{static_cast<ErrorCode>(json.at("code").get<int>()),
                               json.at("message"), json.at("elements"), json.at("pointer")}};
  }
  return fail(ErrorCode::kInternal, "a message of unknown type");
}

}  // namespace

std::string encode_message(const WorkerMessage& message) {
  const Json json = std::visit([](const auto& one) { return to_json(one); }, message);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<WorkerMessage> decode_message(std::string_view text) {
  try {
    return message_from_json(nlohmann::json::parse(text));
  } catch (const nlohmann::json::exception& exception) {
    return fail(ErrorCode::kInternal, std::string("not a message: ") + exception.what());
  }
}

std::string frame_of(std::string_view payload) {
  std::string frame;
  frame.reserve(kLengthBytes + payload.size());
  for (std::size_t i = 0; i < kLengthBytes; ++i) {
    frame.push_back(static_cast<char>(payload.size() >> (8 * (kLengthBytes - 1 - i)) & 0xFFU));
  }
  return frame.append(payload);
}

Result<std::optional<std::string>> FrameReader::next() {
  if (buffer_.size() < kLengthBytes) return std::nullopt;
  std::size_t length = 0;
  for (std::size_t i = 0; i < kLengthBytes; ++i) {
    length = length << 8U | static_cast<unsigned char>(buffer_[i]);
  }
  if (length > kMaxFrameBytes) return fail(ErrorCode::kInternal, "a frame of impossible length");
  if (buffer_.size() < kLengthBytes + length) return std::nullopt;
  std::string payload = buffer_.substr(kLengthBytes, length);
  buffer_.erase(0, kLengthBytes + length);
  return payload;
}

MessageChannel::~MessageChannel() {
  ::close(descriptor_);
}

bool MessageChannel::send(const WorkerMessage& message) {
  const std::string frame = frame_of(encode_message(message));
  std::string_view rest = frame;
  while (!rest.empty()) {
    const ssize_t sent = ::send(descriptor_, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return false;
    rest.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

MessageChannel::Received MessageChannel::take_frame() {
  const auto frame = frames_.next();
  if (!frame) return {Status::kClosed, {}};
  if (!*frame) return {Status::kNothing, {}};
  auto message = decode_message(**frame);
  if (!message) return {Status::kClosed, {}};
  return {Status::kMessage, std::move(*message)};
}

MessageChannel::Received MessageChannel::receive() {
  std::array<char, 4096> piece{};
  while (true) {
    if (Received received = take_frame(); received.status != Status::kNothing) return received;
    const ssize_t got = ::recv(descriptor_, piece.data(), piece.size(), MSG_DONTWAIT);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return {Status::kNothing, {}};
    if (got <= 0) return {Status::kClosed, {}};
    frames_.append({piece.data(), static_cast<std::size_t>(got)});
  }
}

}  // namespace symcell::server
