#include "server/http/crew.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace symcell::server {
namespace {
// A thread without work costs little; hundreds that one rush needed are not kept for the next.
constexpr std::chrono::seconds kIdlePatience{30};
}  // namespace

Crew::Crew(std::size_t most_threads, std::size_t queue_limit)
    : most_threads_(most_threads), queue_limit_(queue_limit) {
}

Crew::~Crew() {
  shutdown();
}

void Crew::reap() {
  for (const std::thread::id id : std::exchange(ended_, {})) {
    const auto ended = std::ranges::find(threads_, id, &std::thread::get_id);
    // It holds the lock for the last time before it is in this list.
    ended->join();
    threads_.erase(ended);
  }
}

bool Crew::try_enqueue(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    reap();
    const bool more = tasks_.size() >= idle_ && threads_.size() < most_threads_;
    if (!more && tasks_.size() >= idle_ + queue_limit_) return false;
    tasks_.push_back(std::move(task));
    if (more) threads_.emplace_back([this] { work(); });
  }
  wake_.notify_one();
  return true;
}

void Crew::shutdown() {
  std::vector<std::thread> threads;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    reap();
    threads = std::exchange(threads_, {});
  }
  wake_.notify_all();
  for (std::thread& thread : threads) thread.join();
}

std::size_t Crew::threads() const {
  const std::lock_guard lock(mutex_);
  return threads_.size() - ended_.size();
}

void Crew::work() {
  while (true) {
    std::function<void()> task;
    {
      std::unique_lock lock(mutex_);
      ++idle_;
      const bool woken =
          wake_.wait_for(lock, kIdlePatience, [this] { return stopping_ || !tasks_.empty(); });
      --idle_;
      if (tasks_.empty()) {
        if (!woken) ended_.push_back(std::this_thread::get_id());
        return;
      }
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    task();
  }
}

}  // namespace symcell::server
