#include "server/worker/process_end.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>

namespace symcell::server {
namespace {

// Libraries that abort when they get no memory do so near the limit; whoever aborts far below it
// has another reason. Resident memory stays below what the limit counts.
constexpr double kNearLimit = 0.8;

// Less than half of what a server is said to need for itself: the kernel, short of memory, ends what is large.
constexpr std::uint64_t kSmallBytes = std::uint64_t{128} << 20U;

std::string signal_name(int signal) {
  const char* name = ::sigabbrev_np(signal);
  return name != nullptr ? "SIG" + std::string(name) : "signal " + std::to_string(signal);
}

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string(bytes >> 20U) + " MiB";
}

std::string seconds_text(double seconds) {
  std::string text = std::to_string(seconds);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text + " s";
}

std::string where(const Progress& progress) {
  return " in phase " + std::string(phase_name(progress.phase)) + " after " +
         std::to_string(progress.elements) + " elements of the cell";
}

std::string how(const ProcessEnd& end) {
  return end.signal != 0 ? "was ended by " + signal_name(end.signal)
                         : "left with status " + std::to_string(end.exit_status);
}

}  // namespace

std::string_view end_kind_name(EndKind kind) {
  switch (kind) {
    case EndKind::kCancelled: return "cancelled";
    case EndKind::kTimeLimit: return "time_limit";
    case EndKind::kMemoryLimit: return "memory_limit";
    case EndKind::kCrash: return "crash";
    case EndKind::kOutside: return "outside";
  }
  return "crash";
}

bool was_small(const ProcessEnd& end, std::uint64_t server_peak_bytes) {
  return end.peak_bytes <= std::max(kSmallBytes, server_peak_bytes);
}

EndKind kind_of(const ProcessEnd& end, const WorkerLimits& limits) {
  if (end.killed == KillReason::kCancel) return EndKind::kCancelled;
  if (end.killed == KillReason::kTimeLimit || end.signal == SIGXCPU) return EndKind::kTimeLimit;
  if (end.signal == 0) {
    return end.exit_status == kMemoryExitStatus ? EndKind::kMemoryLimit : EndKind::kCrash;
  }
  // Nothing in a worker sends these to itself.
  constexpr std::array kForeign{SIGKILL, SIGTERM, SIGINT, SIGHUP, SIGQUIT};
  for (const int foreign : kForeign) {
    if (end.signal == foreign) return EndKind::kOutside;
  }
  const double near = kNearLimit * static_cast<double>(limits.memory_bytes);
  const bool full = limits.memory_bytes != 0 && static_cast<double>(end.peak_bytes) >= near;
  return full ? EndKind::kMemoryLimit : EndKind::kCrash;
}

Error error_of(const ProcessEnd& end,
               const WorkerLimits& limits,
               double time_limit_s,
               const Progress& progress) {
  switch (kind_of(end, limits)) {
    case EndKind::kCancelled: return {ErrorCode::kCancelled, "cancelled on request", {}, {}};
    case EndKind::kTimeLimit: {
      const std::string limit =
          end.signal == SIGXCPU
              ? "limit of " + std::to_string(limits.cpu_seconds) + " s of processor time"
              : "time limit of " + seconds_text(time_limit_s);
      return {ErrorCode::kTimeLimit,
              limit + " reached" + where(progress) + "; raise time_limit or relax the size bounds",
              {},
              {}};
    }
    case EndKind::kMemoryLimit:
      return {ErrorCode::kMemoryLimit,
              "memory limit of " + mebibytes(limits.memory_bytes) + " reached" + where(progress) +
                  "; relax the size bounds, simplify the model, or raise the limit (memory_limit, "
                  "the server's --worker-memory)",
              {},
              {}};
    case EndKind::kOutside:
      return {ErrorCode::kWorkerCrashed,
              "the worker process was killed from outside (" + signal_name(end.signal) + ")" +
                  where(progress) +
                  "; as a rule the machine had no memory left: relax the size bounds or try again",
              {},
              {}};
    case EndKind::kCrash: break;
  }
  return {ErrorCode::kWorkerCrashed,
          "the mesher crashed on this model (its process " + how(end) + ")" + where(progress) +
              "; other options may avoid it (fold, size bounds); the model is worth a bug report",
          {},
          {}};
}

}  // namespace symcell::server
