// The threads that run jobs. The queue is the store's: a thread that is free asks it whose turn is.
//
// Guarantees: at most `workers` jobs run at once; a job that runs has its row in state running; when
// a worker lets go of a job its row is finished or queued again, whatever the engine did, exceptions
// included. While the store or the disk fails, the worker tries again until it works or the server
// stops: no job is left behind by a failure that passes.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"
#include "server/base/clock.hpp"
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
  JobRunner(RunnerParts parts, std::size_t workers);
  // What it counts; before it is made.
  static void declare_metrics(Metrics& metrics);
  // Stops, and waits for whatever made stop() return false.
  ~JobRunner();

  // Starts the threads.
  void start();
  // A job came, or one that had to wait may run now.
  void poke();

  enum class CancelResult : std::uint8_t {
    kStopping,  // runs here: its worker updates the store within a second
    kNotHere,
  };
  CancelResult cancel(std::string_view id);

  [[nodiscard]] std::optional<Progress> progress(std::string_view id) const;
  [[nodiscard]] std::size_t running() const;
  // Jobs that run for longer than their time limit and what a kill may take.
  [[nodiscard]] std::size_t overdue() const;
  [[nodiscard]] std::size_t workers() const { return workers_; }

  // Starts no more jobs, gives those that run `grace`, then cancels and requeues them.
  // False: an engine ignores its cancellation, its thread cannot be joined.
  [[nodiscard]] bool stop(std::chrono::milliseconds grace);

 private:
  struct Running {
    ExecutionContext context;
    std::int32_t attempt = 0;
    std::int64_t started_steady_ms = steady_ms();
    std::atomic<double> limit_s{kInfinity};
    std::atomic<bool> requeue{false};  // cancelled because the server stops, not by the user
  };

  void work();
  // Sleeps until there may be something to run, or the server stops: then false.
  [[nodiscard]] bool wait_for_work(std::uint64_t seen);
  [[nodiscard]] std::optional<Job> claim();
  // Makes a claimed job cancellable.
  std::shared_ptr<Running> enter(const Job& job);
  void run(const Job& job);
  void remove_files_if_deleted(const std::string& id);
  void execute(const Job& job, Running& running);
  // Does `work` again, with longer and longer pauses, while it throws StoreError or what a disk that
  // is full or gone throws. False: the server stops.
  [[nodiscard]] bool persist(const std::string& id, const std::function<void()>& work);
  void count_lost_worker(const std::string& id);
  // Results under their names.
  struct Published {
    std::int64_t bytes = 0;
    std::string statistics;
    std::vector<FileCopy> copies;  // where files are small enough; others are on the disk
  };
  // False: the server stops.
  [[nodiscard]] bool publish(const Job& job, Published& published);
  [[nodiscard]] Result<Published> run_engine(const Job& job, Running& running);
  void count_phases(std::string_view statistics);
  // Of a shared store: tells it which runs are alive, and hears which of them are to end.
  void keep_runs();
  void keep_runs_once();
  void keep_fault(const Job& job, const Error& error);
  void settle(const Job& job, Running& running, Result<Published>& result);

  RunnerParts parts_;
  const std::size_t workers_;

  mutable std::mutex mutex_;         // guards all below but threads_
  std::condition_variable idle_;     // running_ became empty
  std::condition_variable stopped_;  // stopping_ became true
  std::condition_variable wanted_;   // pokes_ or stopping_ changed
  std::map<std::string, std::shared_ptr<Running>, std::less<>> running_;
  std::uint64_t pokes_ = 0;
  std::size_t claiming_ = 0;
  // Jobs to be cancelled that do not run here; one of them may just be claimed.
  std::set<std::string, std::less<>> cancelled_meanwhile_;
  bool stopping_ = false;

  std::vector<std::thread> threads_;
  std::thread keeper_;
};

}  // namespace symcell::server
