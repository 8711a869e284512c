// What the server and its worker processes say to each other over a socket.
//
// A message is a frame: its length in bytes as 4 bytes, big end first, then JSON. Both ends are the
// same program, so there is one version and no negotiation: whoever hears another one hangs up.
//
//   worker  hello                                  once, when it can take work
//   server  request                                one at a time
//   worker  progress ...                           while it works, when something changed
//   server  cancel                                 at most once
//   worker  done | failed                          ends the request
//
// The end of the connection ends the worker.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "server/jobs/job_engine.hpp"
#include "server/worker/process_limits.hpp"

namespace symcell::server {

inline constexpr int kWorkerProtocolVersion = 1;
// The longest message is the document of an inspection; a length above this is no length.
inline constexpr std::size_t kMaxFrameBytes = std::size_t{64} << 20U;

enum class WorkerTask : std::uint8_t { kMesh, kInspect, kRecognise, kDraw };

struct HelloMessage {};
struct RequestMessage {
  WorkerTask task = WorkerTask::kMesh;
  // An inspection uses model, model_format and options, a drawing also cell, the picture's file; to
  // recognise a model takes nothing else.
  EngineJob job;
  bool format_is_known = true;  // else model_format means nothing
  WorkerLimits limits;
};
struct CancelMessage {};
struct ProgressMessage {
  Progress progress;
};
struct DoneMessage {
  std::string document;  // of an inspection; the name of a recognised format; empty for a mesh
};
struct FailedMessage {
  Error error;
};

using WorkerMessage = std::variant<HelloMessage,
                                   RequestMessage,
                                   CancelMessage,
                                   ProgressMessage,
                                   DoneMessage,
                                   FailedMessage>;

// The JSON of one message, without the length. Text that is not UTF-8 is repaired, except in file
// names, which keep their bytes.
[[nodiscard]] std::string encode_message(const WorkerMessage& message);
// Errors: kInternal (no message, another version).
[[nodiscard]] Result<WorkerMessage> decode_message(std::string_view json);

// Takes a stream of bytes apart into frames.
class FrameReader {
 public:
  void append(std::string_view bytes) { buffer_.append(bytes); }
  // The next whole frame; nullopt: more bytes are needed. Errors: kInternal (a length too large).
  [[nodiscard]] Result<std::optional<std::string>> next();

 private:
  std::string buffer_;
};

[[nodiscard]] std::string frame_of(std::string_view payload);

// One end of the connection; owns the descriptor. One thread sends, one (the same or another)
// receives.
class MessageChannel {
 public:
  explicit MessageChannel(int descriptor) : descriptor_(descriptor) {}
  ~MessageChannel();
  MessageChannel(const MessageChannel&) = delete;
  MessageChannel& operator=(const MessageChannel&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }

  // False: the other end is gone.
  [[nodiscard]] bool send(const WorkerMessage& message);

  enum class Status : std::uint8_t { kMessage, kNothing, kClosed };
  struct Received {
    Status status = Status::kNothing;
    WorkerMessage message;  // of kMessage
  };
  // Reads what has come without waiting for more. kClosed: the end, or something that is no
  // message.
  [[nodiscard]] Received receive();

 private:
  [[nodiscard]] Received take_frame();

  int descriptor_;
  FrameReader frames_;
};

}  // namespace symcell::server
