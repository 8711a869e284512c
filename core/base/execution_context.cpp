#include "core/base/execution_context.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace symcell {

std::string_view phase_name(Phase phase) {
  switch (phase) {
    case Phase::kParse: return "parse";
    case Phase::kSymmetry: return "symmetry";
    case Phase::kInitial: return "initial";
    case Phase::kRefine: return "refine";
    case Phase::kImprove: return "improve";
    case Phase::kCell: return "cell";
    case Phase::kWrite: return "write";
    case Phase::kDone: return "done";
  }
  return "done";
}

void ExecutionContext::set_time_limit(double seconds) {
  // A century stands for "no limit": beyond it the clock's arithmetic could overflow.
  constexpr double kCentury = 3.2e9;
  if (!(seconds > 0) || seconds > kCentury) {
    deadline_ = Clock::time_point::max();
    limit_seconds_ = 0;
    return;
  }
  limit_seconds_ = seconds;
  deadline_ = Clock::now() +
              std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

Result<void> ExecutionContext::check(std::uint64_t elements) const {
  if (cancelled()) return fail(ErrorCode::kCancelled, "cancelled on request");
  if (deadline_ != Clock::time_point::max() && Clock::now() > deadline_) {
    std::array<char, 32> seconds{};
    std::snprintf(seconds.data(), seconds.size(), "%.6g", limit_seconds_);
    return fail(ErrorCode::kTimeLimit,
                std::string("time limit of ") + seconds.data() + " s reached after " +
                    std::to_string(elements) +
                    " elements of the cell; raise time_limit or relax the size bounds");
  }
  if (elements > max_elements_) {
    return fail(ErrorCode::kElementLimit,
                "the cell would need more than max_elements = " + std::to_string(max_elements_) +
                    " elements; raise max_elements or relax the bounds on shape and size");
  }
  return {};
}

void ExecutionContext::report(Phase phase,
                              double fraction,
                              std::uint64_t elements,
                              double quality) {
  phase_.store(phase, std::memory_order_relaxed);
  const double previous = fraction_.load(std::memory_order_relaxed);
  fraction_.store(std::max(previous, std::min(fraction, 1.0)), std::memory_order_relaxed);
  elements_.store(elements, std::memory_order_relaxed);
  quality_.store(quality, std::memory_order_relaxed);
}

Progress ExecutionContext::progress() const {
  return {phase_.load(std::memory_order_relaxed), fraction_.load(std::memory_order_relaxed),
          elements_.load(std::memory_order_relaxed), quality_.load(std::memory_order_relaxed)};
}

}  // namespace symcell
