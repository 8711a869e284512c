// The HTTP threads behind a queue of bounded length.
#pragma once

#include <httplib.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace symcell::server {

class BoundedTaskQueue final : public httplib::TaskQueue {
 public:
  BoundedTaskQueue(std::size_t threads, std::size_t limit);

  // A task that finds the queue full runs at once in the calling thread, where overloaded() then
  // holds: it must answer shortly and must not wait. (httplib offers no way to refuse a task, and
  // one that never runs would leak its socket.)
  void enqueue(std::function<void()> task) override;
  // Runs what is queued, then joins.
  void shutdown() override;

  // Tasks that wait for a thread.
  [[nodiscard]] std::size_t waiting() const { return waiting_; }
  // True in a task that runs because the queue was full.
  [[nodiscard]] static bool overloaded();

 private:
  void work();

  const std::size_t limit_;
  std::mutex mutex_;  // guards tasks_ and stopping_
  std::condition_variable wake_;
  std::deque<std::function<void()>> tasks_;
  bool stopping_ = false;
  std::atomic<std::size_t> waiting_{0};  // tasks_.size(), readable without the mutex
  std::vector<std::thread> threads_;
};

}  // namespace symcell::server
