#include "server/jobs/group_sync.hpp"

#include <exception>
#include <utility>

namespace symcell::server {

void GroupSync::committed() {
  const std::lock_guard lock(mutex_);
  ++committed_;
}

void GroupSync::reach() {
  std::unique_lock lock(mutex_);
  const std::uint64_t wanted = committed_;
  while (synchronised_ < wanted) {
    if (at_work_) {
      ended_.wait(lock);
      if (synchronised_ < wanted && !at_work_ && failed_ >= wanted) std::rethrow_exception(fault_);
      continue;
    }
    at_work_ = true;
    const std::uint64_t target = committed_;
    lock.unlock();
    std::exception_ptr fault;
    try {
      sync_();
    } catch (...) {
      fault = std::current_exception();
    }
    lock.lock();
    at_work_ = false;
    if (fault) {
      failed_ = target;
      fault_ = fault;
    } else {
      synchronised_ = target;
    }
    ended_.notify_all();
    if (fault) std::rethrow_exception(fault);
  }
}

}  // namespace symcell::server
