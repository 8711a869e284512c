#include "server/worker/worker_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/base/assert.hpp"

namespace symcell::server {
namespace {

using Clock = std::chrono::steady_clock;

// A program that starts takes milliseconds; on a machine that swaps, seconds.
constexpr std::chrono::seconds kHelloPatience{30};
// How soon a cancel is noticed.
constexpr std::chrono::milliseconds kTick{20};
// Of standard error, the end is kept: an assertion or an abort says why in its last line.
constexpr std::size_t kLastWordsBytes = 2000;

void check(int error, const char* what) {
  if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

// What posix_spawn does between fork and exec. The parent has threads: nothing else is safe there.
class SpawnPlan {
 public:
  SpawnPlan() {
    check(::posix_spawn_file_actions_init(&actions_), "cannot prepare a worker");
    check(::posix_spawnattr_init(&attributes_), "cannot prepare a worker");
  }
  ~SpawnPlan() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  // Standard input is the connection. Sockets of the server's clients must not stay open in a
  // worker, so every other descriptor goes.
  pid_t start(const std::filesystem::path& program, int connection, int error_pipe) {
    check(::posix_spawn_file_actions_adddup2(&actions_, connection, 0), "cannot prepare a worker");
    check(::posix_spawn_file_actions_addopen(&actions_, 1, "/dev/null", O_WRONLY, 0),
          "cannot prepare a worker");
    check(::posix_spawn_file_actions_adddup2(&actions_, error_pipe, 2), "cannot prepare a worker");
    check(::posix_spawn_file_actions_addclosefrom_np(&actions_, 3), "cannot prepare a worker");

    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setsigdefault(&attributes_, &all);
    // A group of its own: Ctrl-C at the terminal is the server's to handle, and a kill reaches what
    // the worker started.
    ::posix_spawnattr_setpgroup(&attributes_, 0);
    ::posix_spawnattr_setflags(
        &attributes_,
        static_cast<short>(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP));

    std::string name = "symcell";
    std::string command = "worker";
    std::string parent = std::to_string(::getpid());
    const std::array<char*, 4> arguments{name.data(), command.data(), parent.data(), nullptr};
    pid_t pid = 0;
    check(::posix_spawn(&pid, program.c_str(), &actions_, &attributes_, arguments.data(), environ),
          "cannot start a worker");
    return pid;
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

// Two connected descriptors; the one that is not taken is closed.
struct Pair {
  std::array<int, 2> ends{-1, -1};
  Pair() = default;
  ~Pair() {
    for (const int end : ends) {
      if (end >= 0) ::close(end);
    }
  }
  Pair(const Pair&) = delete;
  Pair& operator=(const Pair&) = delete;
  int take(std::size_t which) { return std::exchange(ends[which], -1); }
};

}  // namespace

WorkerProcess::WorkerProcess(const std::filesystem::path& program) {
  spawn(program);
  try {
    await_hello();
  } catch (...) {
    end(KillReason::kNone);
    ::close(error_pipe_);
    throw;
  }
}

WorkerProcess::~WorkerProcess() {
  if (pid_ != 0) end(KillReason::kNone);
  ::close(error_pipe_);
}

void WorkerProcess::spawn(const std::filesystem::path& program) {
  Pair connection;
  Pair errors;
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, connection.ends.data()) != 0 ||
      ::pipe2(errors.ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot connect a worker");
  }
  // A worker whose connection's thread is stuck must not hold the server up.
  const timeval patience{5, 0};
  ::setsockopt(connection.ends[0], SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  pid_ = SpawnPlan().start(program, connection.ends[1], errors.ends[1]);
  channel_ = std::make_unique<MessageChannel>(connection.take(0));
  error_pipe_ = errors.take(0);
}

void WorkerProcess::await_hello() {
  const auto deadline = Clock::now() + kHelloPatience;
  while (Clock::now() < deadline && !has_ended()) {
    wait_for_event(kTick);
    const MessageChannel::Received received = channel_->receive();
    if (received.status == MessageChannel::Status::kClosed) break;
    if (received.status == MessageChannel::Status::kNothing) continue;
    if (std::holds_alternative<HelloMessage>(received.message)) return;
    break;
  }
  read_last_words();
  throw std::runtime_error("a worker process did not start: " + last_words_);
}

void WorkerProcess::wait_for_event(std::chrono::milliseconds patience) const {
  std::array<pollfd, 2> events{{{channel_->descriptor(), POLLIN, 0}, {error_pipe_, POLLIN, 0}}};
  ::poll(events.data(), events.size(), static_cast<int>(patience.count()));
}

bool WorkerProcess::has_ended() const {
  siginfo_t info{};
  // Left a zombie: its id stays its own until end() has killed the group of that name.
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == pid_;
}

bool WorkerProcess::usable() const {
  return pid_ != 0 && !has_ended();
}

ProcessEnd WorkerProcess::end(KillReason reason) {
  // Also after its end: children of its own may be left.
  const pid_t group = pid_;
  ::kill(-group, SIGKILL);
  int status = 0;
  rusage usage{};
  while (::wait4(pid_, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  pid_ = 0;
  // Where this process is the first of a container, orphans are handed to it.
  while (::waitpid(-group, nullptr, 0) > 0) {
  }
  read_last_words();
  ProcessEnd result;
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  if (WIFEXITED(status)) result.exit_status = WEXITSTATUS(status);
  result.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  result.killed = reason;
  return result;
}

void WorkerProcess::read_last_words() {
  std::array<char, 4096> piece{};
  while (true) {
    const ssize_t got = ::read(error_pipe_, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return;
    last_words_.append(piece.data(), static_cast<std::size_t>(got));
    if (last_words_.size() > kLastWordsBytes) {
      last_words_.erase(0, last_words_.size() - kLastWordsBytes);
    }
  }
}

TaskOutcome WorkerProcess::end_of_request(const RequestMessage& request,
                                          const ExecutionContext& context,
                                          KillReason reason) {
  const ProcessEnd how = end(reason);
  TaskOutcome outcome{
      fail(error_of(how, request.limits, request.job.options.time_limit_s, context.progress()))};
  outcome.end = kind_of(how, request.limits);
  rusage own{};
  ::getrusage(RUSAGE_SELF, &own);
  outcome.was_small = was_small(how, static_cast<std::uint64_t>(own.ru_maxrss) * 1024);
  outcome.last_words = std::move(last_words_);
  return outcome;
}

TaskOutcome WorkerProcess::run(const RequestMessage& request, ExecutionContext& context) {
  SYMCELL_ASSERT(pid_ != 0);
  ++requests_;
  last_words_.clear();
  if (!channel_->send(request)) return end_of_request(request, context, KillReason::kNone);

  // A century stands for "no limit": beyond it the clock's arithmetic could overflow.
  constexpr double kCentury = 3.2e9;
  const double limit_s = request.job.options.time_limit_s;
  auto deadline = Clock::time_point::max();
  KillReason at_deadline = KillReason::kTimeLimit;
  if (limit_s < kCentury) {
    deadline = Clock::now() + kTimeGrace +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
  }
  bool cancelled = false;
  while (true) {
    read_last_words();
    // Waited for only when all that has come was looked at: frames arrive together.
    MessageChannel::Received received = channel_->receive();
    if (received.status == MessageChannel::Status::kNothing) {
      wait_for_event(kTick);
      received = channel_->receive();
    }
    if (received.status == MessageChannel::Status::kMessage) {
      if (const auto* reported = std::get_if<ProgressMessage>(&received.message)) {
        const Progress& p = reported->progress;
        context.report(p.phase, p.fraction, p.elements, p.quality_reached);
      } else if (const auto* done = std::get_if<DoneMessage>(&received.message)) {
        return {done->document};
      } else if (const auto* failed = std::get_if<FailedMessage>(&received.message)) {
        return {fail(failed->error)};
      }
      continue;
    }
    if (received.status == MessageChannel::Status::kClosed || has_ended()) {
      return end_of_request(request, context, KillReason::kNone);
    }
    if (context.cancelled() && !cancelled) {
      cancelled = true;
      // If the message does not get through, the kill does.
      static_cast<void>(channel_->send(CancelMessage{}));
      deadline = std::min(deadline, Clock::now() + kCancelGrace);
      at_deadline = KillReason::kCancel;
    }
    if (Clock::now() > deadline) return end_of_request(request, context, at_deadline);
  }
}

}  // namespace symcell::server
