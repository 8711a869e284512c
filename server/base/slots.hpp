// A fixed number of places for work that holds a thread for long, taken without waiting.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

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

// Places of which no client takes more than half, where there are more than a few.
class SharedSlots {
 public:
  explicit SharedSlots(std::size_t count)
      : slots_(count), most_of_client_(std::max<std::size_t>(kFew, count / 2)) {}

  // Null if every place is taken, or as many as this client may have. Gives the place back when the
  // last copy goes. The places must outlive it.
  [[nodiscard]] Slots::Slot try_take(const std::string& client) {
    const std::lock_guard lock(mutex_);
    std::size_t& own = taken_[client];
    Slots::Slot place = own < most_of_client_ ? slots_.try_take() : nullptr;
    if (!place) {
      if (own == 0) taken_.erase(client);
      return nullptr;
    }
    ++own;
    return {this, [client, place](SharedSlots* slots) { slots->give_back(client); }};
  }

  [[nodiscard]] std::size_t taken() const { return slots_.taken(); }

 private:
  static constexpr std::size_t kFew = 4;

  void give_back(const std::string& client) {
    const std::lock_guard lock(mutex_);
    const auto own = taken_.find(client);
    if (own != taken_.end() && --own->second == 0) taken_.erase(own);
  }

  std::mutex mutex_;  // guards taken_
  std::map<std::string, std::size_t> taken_;
  Slots slots_;
  std::size_t most_of_client_;
};

}  // namespace symcell::server
