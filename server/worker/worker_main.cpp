#include "server/worker/worker_main.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "api/formats/model_format.hpp"
#include "core/base/execution_context.hpp"
#include "server/base/files.hpp"
#include "server/worker/heap.hpp"
#include "server/worker/local_engine.hpp"
#include "server/worker/process_limits.hpp"
#include "server/worker/process_rights.hpp"
#include "server/worker/protocol.hpp"
#include "server/worker/worker_faults.hpp"

namespace symcell::server {
namespace {

constexpr int kProgressIntervalMs = 50;

// The request that runs, shared by the two threads.
struct Work {
  RequestMessage request;
  ExecutionContext context;
};

WorkerMessage perform(Work& work) {
  const RequestMessage& request = work.request;
  try {
    apply_limits(request.limits);
    reserve_heap(request.limits.memory_bytes);
    reset_peak_memory();
    work.context.set_time_limit(request.job.options.time_limit_s);
    work.context.set_max_elements(request.job.options.max_elements);
    fault_on_purpose(request.job.options.seed);
    LocalEngine engine;
    if (request.task == WorkerTask::kMesh) {
      const auto done = engine.run(request.job, work.context);
      if (!done) return FailedMessage{done.error()};
      return DoneMessage{};
    }
    if (request.task == WorkerTask::kRecognise) {
      const auto promised =
          request.format_is_known ? std::optional(request.job.model_format) : std::nullopt;
      const auto format = engine.recognise(request.job.model, promised, work.context);
      if (!format) return FailedMessage{format.error()};
      return DoneMessage{std::string(model_format_info(*format).name)};
    }
    if (request.task == WorkerTask::kDraw) {
      const auto done = engine.draw(request.job.model, request.job.model_format,
                                    request.job.options, request.job.cell, work.context);
      if (!done) return FailedMessage{done.error()};
      return DoneMessage{};
    }
    auto document = engine.inspect(request.job.model, request.job.model_format, request.job.options,
                                   work.context);
    if (!document) return FailedMessage{document.error()};
    return DoneMessage{std::move(*document)};
  } catch (const std::bad_alloc&) {
    // A size no allocator takes, or memory refused to a child: as good as a limit.
    return FailedMessage{{ErrorCode::kMemoryLimit,
                          "not enough memory for this model; relax the size bounds",
                          {},
                          {}}};
  } catch (const std::system_error& error) {
    const int code = error.code().value();
    const bool disk = error.code().category() == std::generic_category() &&
                      (code == ENOSPC || code == EDQUOT || code == EIO || code == EROFS);
    return FailedMessage{
        {disk ? ErrorCode::kWriteFailed : ErrorCode::kInternal, error.what(), {}, {}}};
  } catch (const std::exception& exception) {
    return FailedMessage{{ErrorCode::kInternal, exception.what(), {}, {}}};
  }
}

bool same(const Progress& a, const Progress& b) {
  return a.phase == b.phase && a.fraction == b.fraction && a.elements == b.elements &&
         a.quality_reached == b.quality_reached;
}

class Worker {
 public:
  explicit Worker(int socket)
      : channel_(socket), finished_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
  ~Worker() { ::close(finished_); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // Never returns: the process ends from the connection's thread.
  [[noreturn]] void run() {
    std::thread([this] { keep_connection(); }).detach();
    while (true) {
      std::shared_ptr<Work> work;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return work_ && !outcome_; });
        work = work_;
      }
      WorkerMessage outcome = perform(*work);
      // What the mesher freed is the machine's again: an idle worker is to cost little.
      release_heap();
      {
        const std::lock_guard lock(mutex_);
        outcome_ = std::move(outcome);
      }
      const std::uint64_t one = 1;
      [[maybe_unused]] const ssize_t written = ::write(finished_, &one, sizeof one);
    }
  }

 private:
  [[noreturn]] void keep_connection() {
    if (!channel_.send(HelloMessage{})) end_process_group();
    Progress last;
    while (true) {
      std::array<pollfd, 2> events{{{channel_.descriptor(), POLLIN, 0}, {finished_, POLLIN, 0}}};
      ::poll(events.data(), events.size(), busy() ? kProgressIntervalMs : -1);
      if (events[0].revents != 0) hear();
      tell_progress(last);
      if (events[1].revents != 0) tell_outcome(last);
    }
  }

  bool busy() {
    const std::lock_guard lock(mutex_);
    return work_ != nullptr;
  }

  void hear() {
    while (true) {
      const MessageChannel::Received received = channel_.receive();
      if (received.status == MessageChannel::Status::kNothing) return;
      // The server is gone or talks nonsense: nothing here is of use to anybody.
      if (received.status == MessageChannel::Status::kClosed) end_process_group();
      const std::lock_guard lock(mutex_);
      if (std::holds_alternative<CancelMessage>(received.message)) {
        // A late one, for a request that has ended, means nothing.
        if (work_) work_->context.cancel();
      } else if (const auto* request = std::get_if<RequestMessage>(&received.message)) {
        if (work_) end_process_group();
        work_ = std::make_shared<Work>();
        work_->request = *request;
        changed_.notify_one();
      }
    }
  }

  void tell_progress(Progress& last) {
    Progress now;
    {
      const std::lock_guard lock(mutex_);
      if (!work_) return;
      now = work_->context.progress();
    }
    if (same(now, last)) return;
    last = now;
    if (!channel_.send(ProgressMessage{now})) end_process_group();
  }

  void tell_outcome(Progress& last) {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(finished_, &count, sizeof count);
    WorkerMessage outcome;
    {
      const std::lock_guard lock(mutex_);
      if (!outcome_) return;
      outcome = std::move(*outcome_);
      outcome_.reset();
      work_.reset();
    }
    last = {};
    if (!channel_.send(outcome)) end_process_group();
  }

  MessageChannel channel_;
  int finished_;
  std::mutex mutex_;  // guards work_ and outcome_
  std::condition_variable changed_;
  std::shared_ptr<Work> work_;            // null: idle
  std::optional<WorkerMessage> outcome_;  // of work_, until it is sent
};

}  // namespace

int run_worker(int socket, pid_t parent) {
  prepare_worker_process();
  prepare_heap();
  die_with_parent(parent);
  if (!give_up_rights()) {
    std::fputs("the kernel filters no system calls: this worker may make any\n", stderr);
  }
  // The mesher may start processes of its own; the connection is not theirs.
  ::fcntl(socket, F_SETFD, FD_CLOEXEC);
  Worker(socket).run();
}

}  // namespace symcell::server
