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
  // Of models whose jobs have no result, failed or cancelled; the jobs stay.
  std::int64_t spent_model_age_s = 0;
};

// Removes what the rules forbid, ages by the store's clock; returns how many jobs went. What is too
// old goes bit by bit, with one call after the other.
std::size_t apply_retention(const RetentionRules& rules, JobStore& store, const JobFiles& files);

// Removes models whose jobs have no result and are old enough; returns how many.
std::size_t remove_spent_models(const RetentionRules& rules,
                                JobStore& store,
                                const JobFiles& files);

// Removes the files of jobs that were erased up to the mark, and forgets these. Most have gone with their jobs:
// what is left is of jobs whose end could not be made to last at once. Returns the mark of now.
std::int64_t tidy_erased(JobStore& store, const JobFiles& files, std::int64_t mark);

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
  std::int64_t erased_mark_ = 0;  // of the thread, as the next
  std::int64_t tidy_at_ms_ = 0;   // by steady_ms
  std::jthread thread_;           // last: it uses all of the above
};

}  // namespace symcell::server
