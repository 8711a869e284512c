// Small files of jobs are not synchronised one by one: copies of them stand in the store. This synchronises all
// of them now and then, and has the store forget the copies.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/base/log.hpp"
#include "server/jobs/job_files.hpp"
#include "server/jobs/job_store.hpp"

namespace symcell::server {

// Up to here a file is small: to write it twice takes less than to wait for the disk once more.
inline constexpr std::size_t kSmallFileBytes = 128UL * 1024;

// Writes files again that a failure of the machine has lost, from their copies, and forgets these.
void restore_copies(JobStore& store, const JobFiles& files, Logger& logger);

class CopyKeeper {
 public:
  // All must outlive it.
  CopyKeeper(JobStore& store, const JobFiles& files, Logger& logger);
  // Copies came.
  void poke();

 private:
  void work(const std::stop_token& stop);

  JobStore& store_;
  const JobFiles& files_;
  Logger& logger_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace symcell::server
