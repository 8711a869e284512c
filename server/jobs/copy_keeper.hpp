// Small files of jobs are not synchronised one by one: copies of them stand in the store. This synchronises all
// of them now and then, and has the store forget the copies.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/base/log.hpp"
#include "server/jobs/job_files.hpp"
#include "server/jobs/job_store.hpp"

namespace symcell::server {

// Up to here a file is small: to write it twice takes less than to wait for the disk once more.
inline constexpr std::size_t kSmallFileBytes = 128UL * 1024;

// How long copies are kept at most, more or less.
inline constexpr std::chrono::milliseconds kCopyInterval{10'000};

// Writes all files again of which there are copies, and forgets these: a failure of the machine may have lost
// files, and an earlier server, or this one, may have met a disk that refused. After that the kernel takes what
// it could not write for written, and only another write has it written.
void restore_copies(JobStore& store, const JobFiles& files, Logger& logger);

class CopyKeeper {
 public:
  // All must outlive it.
  CopyKeeper(JobStore& store,
             const JobFiles& files,
             Logger& logger,
             std::chrono::milliseconds interval = kCopyInterval);
  // Copies came.
  void poke();

 private:
  void work(const std::stop_token& stop);
  void forget();

  JobStore& store_;
  const JobFiles& files_;
  Logger& logger_;
  const std::chrono::milliseconds interval_;
  bool lost_trust_ = false;  // of the thread: the disk refused, and files are to be written again
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace symcell::server
