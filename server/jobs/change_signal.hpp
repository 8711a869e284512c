// Wakes those who wait for a job, or any job, to change.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace symcell::server {

class ChangeSignal {
 public:
  using Clock = std::chrono::steady_clock;
  using Callback = std::function<void()>;
  // While it lives the callback may be called; the last call may still be under way when it has gone. The
  // signal must outlive it.
  using Watch = std::shared_ptr<void>;

  // Take the version, look at the jobs, then wait for a later version: no change is missed.
  [[nodiscard]] std::uint64_t version() const;
  // Returns at the first change of any job after `seen`, at the latest at `deadline`.
  void wait_beyond(std::uint64_t seen, Clock::time_point deadline) const;

  // Calls back after every change of this job, from the thread that made it; the callback must not wait for
  // anything. Watch first, then look at the job: no change is missed.
  [[nodiscard]] Watch watch(std::string_view id, Callback callback) const;

  // This job has changed.
  void notify(std::string_view id);
  // Any job may have changed.
  void notify_all();

 private:
  using Watches = std::multimap<std::string, std::shared_ptr<Callback>, std::less<>>;

  mutable std::mutex mutex_;  // guards all below
  mutable std::condition_variable changed_;
  std::uint64_t version_ = 0;
  mutable Watches watches_;
};

}  // namespace symcell::server
