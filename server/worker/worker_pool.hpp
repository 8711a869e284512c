// The worker processes of a server: some are started ahead, so that a job does not wait for one.
//
// A worker that crashed, reached a limit or was killed, or has had its share of requests, is
// replaced. All are started by one thread of the pool, which lives as long as it: the kernel ties a
// worker's life to the thread that started it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "server/base/log.hpp"
#include "server/worker/worker_process.hpp"

namespace symcell::server {

struct PoolSettings {
  std::filesystem::path program = "/proc/self/exe";
  std::size_t ahead = 1;  // workers kept even if nobody asks; more are started for more requests
  std::size_t requests_per_worker = 200;
};

struct PoolCounts {
  std::size_t idle = 0;
  std::size_t busy = 0;
  std::uint64_t started = 0;
  std::uint64_t retired = 0;  // replaced after their share of requests, or one too many
};

class WorkerPool {
 public:
  WorkerPool(PoolSettings settings, Logger& logger);
  // Requires: every lease is given back. Ends all workers.
  ~WorkerPool();

  using Lease = std::unique_ptr<WorkerProcess>;

  // Waits for a worker. Errors: kInternal (none can be started), those of context.check().
  [[nodiscard]] Result<Lease> acquire(const ExecutionContext& context);
  void give_back(Lease worker);

  [[nodiscard]] PoolCounts counts() const;
  // Why no worker could be started the last time; empty if one could.
  [[nodiscard]] std::string fault() const;

 private:
  void keep(const std::stop_token& stop);
  // Requires: mutex_ held.
  [[nodiscard]] Lease take_idle();
  [[nodiscard]] std::size_t wanted() const;
  [[nodiscard]] bool may_start() const;
  void start_one(std::unique_lock<std::mutex>& lock);

  const PoolSettings settings_;
  Logger& logger_;

  mutable std::mutex mutex_;  // guards all below but keeper_
  std::condition_variable_any wake_keeper_;
  std::condition_variable available_;
  std::vector<Lease> idle_;
  std::size_t busy_ = 0;
  std::size_t waiting_ = 0;  // acquire() calls without a worker
  std::uint64_t started_ = 0;
  std::uint64_t retired_ = 0;
  std::uint64_t failed_starts_ = 0;
  std::string fault_;

  std::jthread keeper_;  // last: it uses all of the above
};

}  // namespace symcell::server
