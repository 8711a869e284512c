// One worker process, seen from the server: started, given requests one after the other, ended.
//
// Promises: `run` returns within kCancelGrace after a cancel and within kTimeGrace after the time
// limit, whatever the process does, and by then a process that did not answer is gone with all it
// started. The destructor leaves no process behind.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "server/worker/process_end.hpp"
#include "server/worker/protocol.hpp"

namespace symcell::server {

// A cancelled request is given this long to end by itself: a second is promised for all of it.
inline constexpr std::chrono::milliseconds kCancelGrace{700};
// A request looks at its time limit itself; this much later it is ended.
inline constexpr std::chrono::milliseconds kTimeGrace{1000};

struct TaskOutcome {
  Result<std::string> document;     // of an inspection; empty for a mesh
  std::optional<EndKind> end = {};  // how the process ended, if it did
  bool was_small = false;           // when it ended
  std::string last_words = {};      // what it wrote to standard error meanwhile, if it ended
};

class WorkerProcess {
 public:
  // Starts `program worker` and waits until it says hello. Throws std::runtime_error if it does
  // not. Beware: the process dies with the calling thread.
  explicit WorkerProcess(const std::filesystem::path& program);
  // Kills it, unless it ended before.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  // Requires: usable(). `context` is looked at for a cancel and given the progress.
  [[nodiscard]] TaskOutcome run(const RequestMessage& request, ExecutionContext& context);

  // It lives and waits for a request.
  [[nodiscard]] bool usable() const;
  [[nodiscard]] std::size_t requests() const { return requests_; }
  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  void spawn(const std::filesystem::path& program);
  void await_hello();
  void wait_for_event(std::chrono::milliseconds patience) const;
  // True if the process has ended; it stays a zombie.
  [[nodiscard]] bool has_ended() const;
  // Kills what is left of the process and its children, and takes its end.
  ProcessEnd end(KillReason reason);
  void read_last_words();
  [[nodiscard]] TaskOutcome end_of_request(const RequestMessage& request,
                                           const ExecutionContext& context,
                                           KillReason reason);

  pid_t pid_ = 0;  // 0: taken
  std::unique_ptr<MessageChannel> channel_;
  int error_pipe_ = -1;
  std::string last_words_;
  std::size_t requests_ = 0;
};

}  // namespace symcell::server
