// Tells every connection at once that the server stops, and how long requests under way may take.
#pragma once

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <stdexcept>

namespace symcell::server {

class StopSignal {
 public:
  using Clock = std::chrono::steady_clock;

  StopSignal() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (descriptor_ < 0) throw std::runtime_error("cannot create an eventfd");
  }
  ~StopSignal() { ::close(descriptor_); }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  void raise(std::chrono::milliseconds patience) {
    give_up_at_ = (Clock::now() + patience).time_since_epoch().count();
    const std::uint64_t one = 1;
    // Can only fail when the counter is full, and then it is readable anyhow.
    static_cast<void>(::write(descriptor_, &one, sizeof(one)) == sizeof(one));
  }

  // Readable, for ever, once the signal is raised.
  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] bool raised() const { return give_up_at_ != 0; }
  // Requires: raised().
  [[nodiscard]] Clock::time_point give_up_at() const {
    return Clock::time_point(Clock::duration(give_up_at_));
  }

 private:
  int descriptor_;
  std::atomic<Clock::rep> give_up_at_{0};  // 0: not raised
};

}  // namespace symcell::server
