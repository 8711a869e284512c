#include "server/worker/worker_pool.hpp"

#include <chrono>
#include <exception>
#include <utility>

namespace symcell::server {
namespace {
// Before the next try when no worker could be started: the machine is short of something.
constexpr std::chrono::milliseconds kRetryPause{500};
// How soon a waiting request notices its cancel.
constexpr std::chrono::milliseconds kAcquireTick{50};
}  // namespace

WorkerPool::WorkerPool(PoolSettings settings, Logger& logger)
    : settings_(std::move(settings)),
      logger_(logger),
      keeper_([this](const std::stop_token& stop) { keep(stop); }) {
}

WorkerPool::~WorkerPool() {
  keeper_.request_stop();
  keeper_.join();
}

WorkerPool::Lease WorkerPool::take_idle() {
  while (!idle_.empty()) {
    Lease worker = std::move(idle_.back());
    idle_.pop_back();
    if (worker->usable()) return worker;
    logger_.warning("idle_worker_died", {{"pid", std::int64_t{worker->pid()}}});
  }
  return nullptr;
}

Result<WorkerPool::Lease> WorkerPool::acquire(const ExecutionContext& context) {
  std::unique_lock lock(mutex_);
  const std::uint64_t failed_before = failed_starts_;
  ++waiting_;
  while (true) {
    if (Lease worker = take_idle()) {
      --waiting_;
      ++busy_;
      wake_keeper_.notify_one();
      return worker;
    }
    wake_keeper_.notify_one();
    available_.wait_for(lock, kAcquireTick);
    if (const auto go_on = context.check(); !go_on) {
      --waiting_;
      return error_of(go_on);
    }
    if (failed_starts_ > failed_before + 1 && idle_.empty()) {
      --waiting_;
      return fail(ErrorCode::kInternal, "no worker process can be started: " + fault_);
    }
  }
}

void WorkerPool::give_back(Lease worker) {
  // Ended outside the lock: that waits for the kernel.
  Lease spent;
  {
    const std::lock_guard lock(mutex_);
    --busy_;
    if (!worker->usable()) {
      spent = std::move(worker);
    } else if (worker->requests() >= settings_.requests_per_worker ||
               idle_.size() + busy_ >= settings_.ahead + waiting_) {
      ++retired_;
      spent = std::move(worker);
    } else {
      idle_.push_back(std::move(worker));
    }
  }
  available_.notify_one();
  wake_keeper_.notify_one();
}

std::size_t WorkerPool::wanted() const {
  return std::max(settings_.ahead, busy_ + waiting_);
}

bool WorkerPool::may_start() const {
  return idle_.size() + busy_ < wanted();
}

void WorkerPool::start_one(std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  Lease worker;
  std::string fault;
  try {
    worker = std::make_unique<WorkerProcess>(settings_.program);
  } catch (const std::exception& exception) {
    fault = exception.what();
    logger_.error("worker_start_failed", {{"what", std::string_view(fault)}});
  }
  lock.lock();
  fault_ = fault;
  if (worker) {
    ++started_;
  } else {
    ++failed_starts_;
  }
  if (worker && may_start()) {
    idle_.push_back(std::move(worker));
  } else if (worker) {
    // Meanwhile another was given back to the one that waited. The end waits for the kernel.
    ++retired_;
    lock.unlock();
    worker.reset();
    lock.lock();
  }
  available_.notify_all();
}

void WorkerPool::keep(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (!wake_keeper_.wait(lock, stop, [this] { return may_start(); })) break;
    start_one(lock);
    if (!fault_.empty()) {
      wake_keeper_.wait_for(lock, stop, kRetryPause, [] { return false; });
    }
  }
  idle_.clear();
}

PoolCounts WorkerPool::counts() const {
  const std::lock_guard lock(mutex_);
  return {idle_.size(), busy_, started_, retired_};
}

std::string WorkerPool::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

}  // namespace symcell::server
