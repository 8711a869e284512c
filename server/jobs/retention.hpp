// How long finished jobs are kept, and the thread that removes them.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

#include "server/base/log.hpp"
#include "server/jobs/job_files.hpp"
#include "server/jobs/job_store.hpp"

namespace symcell::server {

// Zero: no bound.
struct RetentionRules {
  std::int64_t max_age_s = 0;  // since the job finished
  std::int64_t max_jobs = 0;   // finished ones
  std::int64_t max_bytes = 0;  // of all jobs together; finished ones go, oldest first
};

// Removes what the rules forbid; returns how many jobs went.
std::size_t apply_retention(const RetentionRules& rules,
                            JobStore& store,
                            const JobFiles& files,
                            std::int64_t time_ms);

// Applies the rules at start, every minute, and soon after poke().
class RetentionKeeper {
 public:
  RetentionKeeper(RetentionRules rules, JobStore& store, const JobFiles& files, Logger& logger);
  ~RetentionKeeper();

  void poke();

 private:
  void work(const std::stop_token& stop);

  RetentionRules rules_;
  JobStore& store_;
  const JobFiles& files_;
  Logger& logger_;
  std::mutex mutex_;  // guards poked_
  std::condition_variable_any wake_;
  bool poked_ = true;
  std::int64_t erased_mark_ = 0;  // of the thread
  std::jthread thread_;           // last: it uses all of the above
};

}  // namespace symcell::server
