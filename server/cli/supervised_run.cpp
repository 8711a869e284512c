#include "server/cli/supervised_run.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "server/cli/interrupt.hpp"
#include "server/cli/progress_bar.hpp"
#include "server/worker/heap.hpp"
#include "server/worker/process_end.hpp"
#include "server/worker/process_limits.hpp"

namespace symcell::cli {
namespace {

using Clock = std::chrono::steady_clock;
using server::KillReason;

// As the service has it (server/worker/worker_process.hpp): a cancel is heard within a second, a
// time limit is looked at by the work itself first.
constexpr std::chrono::milliseconds kCancelGrace{1000};
constexpr std::chrono::milliseconds kTimeGrace{2000};
constexpr int kTickMs = 20;

// A context that parent and child see: the one cancels, the other reports its progress.
static_assert(std::atomic<double>::is_always_lock_free && std::atomic<Phase>::is_always_lock_free,
              "only such atomics work between processes");

class SharedContext {
 public:
  SharedContext()
      : memory_(::mmap(nullptr,
                       sizeof(ExecutionContext),
                       PROT_READ | PROT_WRITE,
                       MAP_SHARED | MAP_ANONYMOUS,
                       -1,
                       0)) {
    if (memory_ == MAP_FAILED) throw std::bad_alloc();
    context_ = new (memory_) ExecutionContext();
  }
  ~SharedContext() {
    context_->~ExecutionContext();
    ::munmap(memory_, sizeof(ExecutionContext));
  }
  SharedContext(const SharedContext&) = delete;
  SharedContext& operator=(const SharedContext&) = delete;
  [[nodiscard]] ExecutionContext& get() { return *context_; }

 private:
  void* memory_;
  ExecutionContext* context_ = nullptr;
};

std::string encode(const Result<std::string>& result) {
  using Json = nlohmann::json;
  Json json;
  if (result) {
    json = {{"text", *result}};
  } else {
    const Error& e = result.error();
    json = {{"code", static_cast<int>(e.code)},
            {"message", e.message},
            {"elements", e.elements},
            {"pointer", e.pointer}};
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// nullopt: the text is not whole.
std::optional<Result<std::string>> decode(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  if (json.contains("text")) return json.at("text").get<std::string>();
  return fail(static_cast<ErrorCode>(json.at("code").get<int>()), json.at("message"),
              json.at("elements"), json.at("pointer"));
}

Result<std::string> result_of(const SupervisedWork& work, ExecutionContext& context) {
  try {
    return work(context);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kMemoryLimit, "out of memory; relax the size bounds");
  } catch (const std::exception& exception) {
    return fail(ErrorCode::kInternal, exception.what());
  }
}

[[noreturn]] void run_child(const SupervisedWork& work,
                            ExecutionContext& context,
                            const SupervisedSettings& settings,
                            pid_t parent,
                            int result_pipe) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(server::kOrphanExitStatus);
  // A terminal sends these to both processes: the parent hears them and cancels.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  // A reader that has had enough of standard output is told by the write.
  std::signal(SIGPIPE, SIG_IGN);
  server::apply_limits({settings.memory_bytes, 0});
  server::prepare_heap();
  server::reserve_heap(settings.memory_bytes);
  Result<std::string> result = result_of(work, context);
  // The last of what was written leaves only now.
  if (std::fflush(nullptr) != 0 && result) {
    result = fail(ErrorCode::kWriteFailed, std::string("cannot write standard output: ") +
                                               std::generic_category().message(errno));
  }
  const std::string text = encode(result);
  std::string_view rest = text;
  while (!rest.empty()) {
    const ssize_t n = ::write(result_pipe, rest.data(), rest.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) break;
    rest.remove_prefix(static_cast<std::size_t>(n));
  }
  // Not exit(): open outputs are the parent's to keep or to remove.
  ::_exit(0);
}

// Reads what the child says until it has ended, and ends it if need be.
class Supervisor {
 public:
  Supervisor(pid_t child, int result_pipe, const SupervisedSettings& settings)
      : child_(child), pipe_(result_pipe) {
    constexpr double kLongest =
        3.2e9;  // a century: beyond it the clock's arithmetic could overflow
    if (settings.time_limit_s < kLongest) {
      deadline_ = Clock::now() + kTimeGrace +
                  std::chrono::duration_cast<Clock::duration>(
                      std::chrono::duration<double>(settings.time_limit_s));
    }
  }

  server::ProcessEnd watch(const ExecutionContext& context) {
    server::ProcessEnd end;
    bool cancelled = false;
    auto reason = KillReason::kTimeLimit;
    while (read_some()) {
      if (context.cancelled() && !cancelled) {
        cancelled = true;
        deadline_ = std::min(deadline_, Clock::now() + kCancelGrace);
        reason = KillReason::kCancel;
      }
      // The limit is the mesher's; outputs may be large and their disk slow.
      const bool writes =
          reason == KillReason::kTimeLimit && context.progress().phase >= Phase::kWrite;
      if (Clock::now() > deadline_ && !writes && end.killed == KillReason::kNone) {
        ::kill(child_, SIGKILL);
        end.killed = reason;
      }
    }
    int status = 0;
    rusage usage{};
    while (::wait4(child_, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
    if (WIFEXITED(status)) end.exit_status = WEXITSTATUS(status);
    end.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return end;
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  // False: the child has closed its end.
  bool read_some() {
    pollfd event{pipe_, POLLIN, 0};
    if (::poll(&event, 1, kTickMs) <= 0) return true;
    std::array<char, 4096> piece{};
    const ssize_t got = ::read(pipe_, piece.data(), piece.size());
    if (got < 0) return errno == EINTR;
    text_.append(piece.data(), static_cast<std::size_t>(got));
    return got > 0;
  }

  pid_t child_;
  int pipe_;
  Clock::time_point deadline_ = Clock::time_point::max();
  std::string text_;
};

}  // namespace

Result<std::string> run_supervised(const SupervisedWork& work, const SupervisedSettings& settings) {
  SharedContext shared;
  ExecutionContext& context = shared.get();
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    return fail(ErrorCode::kInternal, "no pipe to a child process could be had");
  }
  std::fflush(nullptr);
  const InterruptCancels interrupt(context);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) {
    ::close(pipe[0]);
    ::close(pipe[1]);
    return fail(ErrorCode::kInternal, "a child process could not be started");
  }
  if (child == 0) {
    ::close(pipe[0]);
    run_child(work, context, settings, parent, pipe[1]);
  }
  ::close(pipe[1]);
  Supervisor supervisor(child, pipe[0], settings);
  ProgressBar bar(context, settings.progress_bar);
  const server::ProcessEnd end = supervisor.watch(context);
  bar.stop();
  ::close(pipe[0]);
  if (auto result = decode(supervisor.text())) return *result;
  return fail(
      server::error_of(end, {settings.memory_bytes, 0}, settings.time_limit_s, context.progress()));
}

}  // namespace symcell::cli
