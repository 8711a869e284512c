// Threads that are started as they are needed, up to a number, behind a queue of bounded length.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace symcell::server {

class Crew {
 public:
  // `queue_limit`: tasks that may wait for a thread once all are busy.
  Crew(std::size_t most_threads, std::size_t queue_limit);
  // Runs what is queued first.
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  // False: all threads are busy and the queue is full; the task is not taken.
  [[nodiscard]] bool try_enqueue(std::function<void()> task);
  // Runs what is queued, then joins.
  void shutdown();

  [[nodiscard]] std::size_t threads() const;

 private:
  void work();
  // Requires: mutex_ held. Joins threads that found nothing to do for a while and ended.
  void reap();

  const std::size_t most_threads_;
  const std::size_t queue_limit_;
  mutable std::mutex mutex_;  // guards all below
  std::condition_variable wake_;
  std::deque<std::function<void()>> tasks_;
  std::vector<std::thread> threads_;
  std::vector<std::thread::id> ended_;
  std::size_t idle_ = 0;
  bool stopping_ = false;
};

}  // namespace symcell::server
