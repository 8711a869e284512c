#include "server/http/task_queue.hpp"

#include <utility>

namespace symcell::server {
namespace {
thread_local bool running_overloaded = false;
}  // namespace

BoundedTaskQueue::BoundedTaskQueue(std::size_t threads, std::size_t limit) : limit_(limit) {
  threads_.reserve(threads);
  for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

bool BoundedTaskQueue::overloaded() {
  return running_overloaded;
}

void BoundedTaskQueue::enqueue(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    if (tasks_.size() < limit_) {
      tasks_.push_back(std::move(task));
      waiting_ = tasks_.size();
      task = nullptr;
    }
  }
  if (!task) {
    wake_.notify_one();
    return;
  }
  running_overloaded = true;
  task();
  running_overloaded = false;
}

void BoundedTaskQueue::shutdown() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void BoundedTaskQueue::work() {
  while (true) {
    std::function<void()> task;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
      if (tasks_.empty()) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
      waiting_ = tasks_.size();
    }
    task();
  }
}

}  // namespace symcell::server
