// One synchronisation of a file for all who wait for one.
//
// Whoever commits says so by committed(), and then waits in reach() until all that was committed before is on
// the disk. The first of those who wait synchronises; the others wait for it or, if they came while it was at
// work already, for the next one. Others may go on committing meanwhile.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>

namespace symcell::server {

class GroupSync {
 public:
  // `sync`: makes last what was committed before it is called; throws if it cannot. Never called twice at
  // once.
  explicit GroupSync(std::function<void()> sync) : sync_(std::move(sync)) {}

  void committed();
  // Throws what `sync` threw for this caller or for the one it waited for.
  void reach();

 private:
  const std::function<void()> sync_;
  std::mutex mutex_;  // guards all below
  std::condition_variable ended_;
  std::uint64_t committed_ = 0;
  std::uint64_t synchronised_ = 0;  // of those committed
  std::uint64_t failed_ = 0;        // up to where the last attempt that failed would have come
  std::exception_ptr fault_;        // of that attempt
  bool at_work_ = false;
};

}  // namespace symcell::server
