#include "server/jobs/change_signal.hpp"

#include <utility>
#include <vector>

namespace symcell::server {

std::uint64_t ChangeSignal::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

void ChangeSignal::wait_beyond(std::uint64_t seen, Clock::time_point deadline) const {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, deadline, [&] { return version_ != seen; });
}

ChangeSignal::Watch ChangeSignal::watch(std::string_view id, Callback callback) const {
  const std::lock_guard lock(mutex_);
  const auto at =
      watches_.emplace(std::string(id), std::make_shared<Callback>(std::move(callback)));
  return {at->second.get(), [this, at](void*) {
            const std::lock_guard leaving(mutex_);
            watches_.erase(at);
          }};
}

// Called without the lock: whoever is called may watch, or cease to.
void ChangeSignal::notify(std::string_view id) {
  std::vector<std::shared_ptr<Callback>> called;
  {
    const std::lock_guard lock(mutex_);
    ++version_;
    const auto [begin, end] = watches_.equal_range(id);
    for (auto at = begin; at != end; ++at) called.push_back(at->second);
  }
  changed_.notify_all();
  for (const auto& callback : called) (*callback)();
}

void ChangeSignal::notify_all() {
  std::vector<std::shared_ptr<Callback>> called;
  {
    const std::lock_guard lock(mutex_);
    ++version_;
    for (const auto& [id, callback] : watches_) called.push_back(callback);
  }
  changed_.notify_all();
  for (const auto& callback : called) (*callback)();
}

}  // namespace symcell::server
