// A fixed number of places for work that holds a thread for long, taken without waiting.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

namespace symcell::server {

class Slots {
 public:
  explicit Slots(std::size_t count) : free_(static_cast<std::ptrdiff_t>(count)), count_(count) {}
  Slots(const Slots&) = delete;
  Slots& operator=(const Slots&) = delete;

  // Gives the place back when the last copy goes. The Slots must outlive it.
  using Slot = std::shared_ptr<void>;

  // Null if every place is taken.
  [[nodiscard]] Slot try_take() {
    if (free_.fetch_sub(1) <= 0) {
      free_.fetch_add(1);
      return nullptr;
    }
    return {this, [](Slots* slots) { slots->free_.fetch_add(1); }};
  }

  [[nodiscard]] std::size_t taken() const {
    const std::ptrdiff_t free = free_.load();
    return count_ - static_cast<std::size_t>(free < 0 ? 0 : free);
  }

 private:
  std::atomic<std::ptrdiff_t> free_;
  std::size_t count_;
};

}  // namespace symcell::server
