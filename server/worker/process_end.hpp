// How a worker process ended, and what that means for the request it had.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "server/worker/process_limits.hpp"

namespace symcell::server {

// Why the server killed it.
enum class KillReason : std::uint8_t { kNone, kCancel, kTimeLimit };

struct ProcessEnd {
  int signal = 0;       // 0: it exited
  int exit_status = 0;  // of an exit
  std::uint64_t peak_bytes = 0;
  KillReason killed = KillReason::kNone;
};

enum class EndKind : std::uint8_t {
  kCancelled,    // killed by the server
  kTimeLimit,    // killed by the server or, for processor time, by the kernel
  kMemoryLimit,  // refused memory
  kCrash,        // a signal of its own making, or an unexpected exit
  kOutside,      // killed by somebody else: the operator, the kernel when memory is short
};

[[nodiscard]] std::string_view end_kind_name(EndKind kind);
// Whether the process was too small to be what a machine short of memory is short for. `server_peak_bytes`: of
// the process that started it, for which the kernel counts it as large as that (wait4(2) after exec).
[[nodiscard]] bool was_small(const ProcessEnd& end, std::uint64_t server_peak_bytes);
[[nodiscard]] EndKind kind_of(const ProcessEnd& end, const WorkerLimits& limits);

// The error of the request. `progress`: as last reported. `time_limit_s`: of the request.
[[nodiscard]] Error error_of(const ProcessEnd& end,
                             const WorkerLimits& limits,
                             double time_limit_s,
                             const Progress& progress);

}  // namespace symcell::server
