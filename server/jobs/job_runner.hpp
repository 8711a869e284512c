// The queue of jobs and the threads that run them.
//
// Guarantees: at most `workers` jobs run at once, in order of acceptance; a job that runs has its
// row in state running; when a worker lets go of a job its row is finished or queued again,
// whatever the engine did, exceptions included. While the store or the disk fails, the worker tries
// again until it works or the server stops: no job is left behind by a failure that passes.
#pragma once

#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/execution_context.hpp"
#include "server/base/fault_archive.hpp"
#include "server/base/log.hpp"
#include "server/base/metrics.hpp"
#include "server/jobs/change_signal.hpp"
#include "server/jobs/job_engine.hpp"
#include "server/jobs/job_files.hpp"
#include "server/jobs/job_store.hpp"

namespace symcell::server {

// What the runner works with; all must outlive it.
struct RunnerParts {
  JobEngine& engine;
  JobStore& store;
  const JobFiles& files;
  const FaultArchive& faults;
  ChangeSignal& changes;
  Metrics& metrics;
  Logger& logger;
};

class JobRunner {
 public:
  JobRunner(RunnerParts parts, std::size_t workers, std::size_t queue_limit);
  // Requires: stop() returned true.
  ~JobRunner();

  // A place in the queue for a job about to be stored; false if the queue is full or stopping.
  [[nodiscard]] bool try_reserve();
  void release_reservation();
  // Uses up one reservation.
  void enqueue_reserved(std::string id);
  // For jobs that were accepted before, which are never refused.
  void enqueue_recovered(std::string id);

  enum class CancelResult : std::uint8_t {
    kDequeued,  // was waiting: the caller updates the store
    kStopping,  // runs: its worker updates the store within a second
    kNotHere,   // neither waits nor runs
  };
  CancelResult cancel(std::string_view id);

  [[nodiscard]] std::optional<Progress> progress(std::string_view id) const;
  [[nodiscard]] std::size_t queued() const;
  [[nodiscard]] std::size_t running() const;
  [[nodiscard]] std::size_t queue_limit() const { return queue_limit_; }
  [[nodiscard]] std::size_t workers() const { return workers_; }

  // Starts no more jobs, gives those that run `grace`, then cancels and requeues them.
  // False: an engine ignores its cancellation, its thread cannot be joined.
  [[nodiscard]] bool stop(std::chrono::milliseconds grace);

 private:
  struct Running {
    ExecutionContext context;
    std::int64_t started_steady_ms = 0;  // of the worker's thread
    std::atomic<bool> requeue{false};    // cancelled because the server stops, not by the user
  };

  void post();
  void run_next();
  void remove_files_if_deleted(const std::string& id);
  void execute(const std::string& id, Running& running);
  // Does `work` again, with longer and longer pauses, while it throws StoreError or what a disk that
  // is full or gone throws. False: the server stops.
  [[nodiscard]] bool persist(const std::string& id, const std::function<void()>& work);
  void count_lost_worker(const std::string& id);
  // Moves the results to their names.
  [[nodiscard]] bool publish(const std::string& id);
  [[nodiscard]] Result<void> run_engine(const Job& job, Running& running);
  void keep_fault(const Job& job, const Error& error);
  void settle(const Job& job, Running& running, const Result<void>& result);

  RunnerParts parts_;
  const std::size_t workers_;
  const std::size_t queue_limit_;

  // Guards waiting_, running_, reserved_ and stopping_.
  mutable std::mutex mutex_;
  std::condition_variable idle_;     // running_ became empty
  std::condition_variable stopped_;  // stopping_ became true
  std::deque<std::string> waiting_;
  std::map<std::string, std::shared_ptr<Running>, std::less<>> running_;
  std::size_t reserved_ = 0;
  bool stopping_ = false;

  boost::asio::thread_pool pool_;
};

}  // namespace symcell::server
