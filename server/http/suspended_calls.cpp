#include "server/http/suspended_calls.hpp"

#include <exception>
#include <limits>
#include <vector>

namespace symcell::server {
namespace {
// Of looks that wait for a thread. Each call has one at most, and calls are limited by their places.
constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max() / 2;
}  // namespace

SuspendedCalls::SuspendedCalls(std::size_t threads)
    : crew_(threads, kNoLimit), timer_([this](const std::stop_token& stop) { keep_time(stop); }) {
}

SuspendedCalls::~SuspendedCalls() {
  shutdown();
}

void SuspendedCalls::shutdown() {
  timer_.request_stop();
  if (timer_.joinable()) timer_.join();
  crew_.shutdown();
  std::set<Held> left;
  {
    const std::lock_guard lock(mutex_);
    due_.clear();
    left.swap(entries_);
  }
  // Their watches first: whoever still calls one finds nobody.
  for (const Held& entry : left) entry->watch.reset();
}

void SuspendedCalls::add(std::shared_ptr<SuspendedCall> call,
                         std::shared_ptr<Connection> connection,
                         Finish finish) {
  const auto entry = std::make_shared<Entry>();
  entry->call = std::move(call);
  entry->connection = std::move(connection);
  entry->finish = std::move(finish);
  {
    const std::lock_guard lock(mutex_);
    entries_.insert(entry);
  }
  {
    // Whoever is woken meanwhile waits until the watch is there.
    const std::lock_guard lock(entry->mutex);
    entry->watch = entry->call->watch([this, weak = std::weak_ptr(entry)] { wake(weak); });
  }
  // What happened before the watch.
  wake(entry);
}

void SuspendedCalls::wake(const std::weak_ptr<Entry>& weak) {
  const Held entry = weak.lock();
  if (!entry || entry->woken.exchange(true)) return;
  static_cast<void>(crew_.try_enqueue([this, entry] { look(entry); }));
}

void SuspendedCalls::look(const Held& entry) {
  const std::lock_guard looking(entry->mutex);
  // Before the look: who wakes from now on may know more than it finds.
  entry->woken = false;
  if (entry->over) return;
  try {
    entry->over = entry->call->look(*entry->connection);
  } catch (const std::exception&) {
    // The store fails most likely, which is told there. An answer meets the same and tells the client; who
    // follows a stream comes again.
    entry->over = true;
  }
  {
    const std::lock_guard lock(mutex_);
    due_.erase({entry->due, entry});
    if (entry->over) {
      entries_.erase(entry);
    } else {
      entry->due = entry->call->look_again_at();
      due_.insert({entry->due, entry});
    }
  }
  changed_.notify_one();
  if (!entry->over) return;
  entry->watch.reset();
  entry->finish();
  entry->finish = nullptr;
  entry->connection.reset();
}

void SuspendedCalls::keep_time(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (due_.empty()) {
      changed_.wait(lock, stop, [this] { return !due_.empty(); });
      continue;
    }
    const auto next = due_.begin()->first;
    if (next > Clock::now()) {
      changed_.wait_until(lock, stop, next,
                          [&] { return due_.empty() || due_.begin()->first < next; });
      continue;
    }
    const Held entry = due_.begin()->second;
    due_.erase(due_.begin());
    lock.unlock();
    wake(entry);
    lock.lock();
  }
}

}  // namespace symcell::server
