// Wakes those who wait for any job to change.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace symcell::server {

class ChangeSignal {
 public:
  using Clock = std::chrono::steady_clock;

  // Take the version, look at the job, then wait for a later version: no change is missed.
  [[nodiscard]] std::uint64_t version() const {
    const std::lock_guard lock(mutex_);
    return version_;
  }

  void notify() {
    {
      const std::lock_guard lock(mutex_);
      ++version_;
    }
    changed_.notify_all();
  }

  // Returns at the first change after `seen`, at the latest at `deadline`.
  void wait_beyond(std::uint64_t seen, Clock::time_point deadline) const {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, deadline, [&] { return version_ != seen; });
  }

 private:
  mutable std::mutex mutex_;  // guards version_
  mutable std::condition_variable changed_;
  std::uint64_t version_ = 0;
};

}  // namespace symcell::server
