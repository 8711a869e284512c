// What a long call looks at every few hundred steps: a cancel flag, a deadline, an element budget;
// and where it reports its progress.
//
// Promises: a call that finds the context exhausted returns kCancelled, kTimeLimit or kElementLimit
// (cancel wins over the deadline, the deadline over the budget) and hands out no partial mesh.
// One context belongs to one call; only `cancel` and `progress` may be used from other threads.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string_view>

#include "core/base/error.hpp"

namespace symcell {

enum class Phase : std::uint8_t {
  kParse,
  kSymmetry,
  kInitial,
  kRefine,
  kImprove,
  kCell,
  kWrite,
  kDone
};

[[nodiscard]] std::string_view phase_name(Phase phase);

// A snapshot that any thread may take.
struct Progress {
  Phase phase = Phase::kParse;
  double fraction = 0;         // 0 to 1 over the whole call, never decreasing
  std::uint64_t elements = 0;  // elements of the cell so far
  double quality_reached = 0;  // share of elements that keep all bounds, 0 to 1
};

class ExecutionContext {
 public:
  using Clock = std::chrono::steady_clock;

  ExecutionContext() = default;
  ExecutionContext(const ExecutionContext&) = delete;
  ExecutionContext& operator=(const ExecutionContext&) = delete;

  void set_time_limit(double seconds);  // counted from now; <= 0 or inf: none
  void set_max_elements(std::uint64_t n) { max_elements_ = n; }
  [[nodiscard]] std::uint64_t max_elements() const { return max_elements_; }

  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

  // Reads the clock: call it every few hundred steps.  `elements`: elements of the cell so far.
  [[nodiscard]] Result<void> check(std::uint64_t elements = 0) const;

  void report(Phase phase, double fraction, std::uint64_t elements = 0, double quality = 0);
  [[nodiscard]] Progress progress() const;

 private:
  std::atomic<bool> cancelled_{false};
  Clock::time_point start_ = Clock::now();
  Clock::time_point deadline_ = Clock::time_point::max();
  double limit_seconds_ = 0;
  std::uint64_t max_elements_ = std::numeric_limits<std::uint64_t>::max();
  // Progress: written by the working thread, read by any.
  std::atomic<Phase> phase_{Phase::kParse};
  std::atomic<double> fraction_{0};
  std::atomic<std::uint64_t> elements_{0};
  std::atomic<double> quality_{0};
};

}  // namespace symcell
