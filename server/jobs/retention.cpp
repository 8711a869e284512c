#include "server/jobs/retention.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <vector>

#include "server/base/clock.hpp"

namespace symcell::server {
namespace {

constexpr std::size_t kBatch = 100;
// What one sweep, a minute, may remove for its age: this many jobs, or this share (a 20th) of all.
// Whatever is wrong with ages, there is time to notice it.
constexpr std::int64_t kLeastPerSweep = 100;
constexpr std::int64_t kShareOfASweep = 20;
constexpr std::chrono::minutes kInterval{1};
// After a sweep, however many jobs come: each of them would cost a look at the oldest.
constexpr std::chrono::milliseconds kPause{500};

std::int64_t finished_count(const StoreTotals& totals) {
  std::int64_t count = 0;
  for (const JobState state : kAllJobStates) {
    if (is_finished(state)) count += totals.by_state[static_cast<std::size_t>(state)];
  }
  return count;
}

}  // namespace

std::size_t apply_retention(const RetentionRules& rules, JobStore& store, const JobFiles& files) {
  std::size_t removed = 0;
  const std::int64_t time_ms = store.clock_ms();
  StoreTotals totals = store.totals();
  std::int64_t finished = finished_count(totals);
  std::int64_t may_age = std::max(kLeastPerSweep, finished / kShareOfASweep);
  // The rows first: files without a row are swept, a row without files would be an error.
  std::vector<std::string> erased;
  const auto remove_files = [&] {
    if (erased.empty()) return;
    store.make_durable();
    for (const std::string& id : erased) files.remove(id);
    removed += erased.size();
    erased.clear();
  };
  // Most often there is nothing to remove, and the oldest one shows it.
  for (std::size_t batch = 1;; batch = kBatch) {
    const auto oldest = store.oldest_finished(batch);
    if (oldest.empty()) return removed;
    for (const Job& job : oldest) {
      const std::int64_t age_ms = time_ms - job.finished_clock_ms.value_or(time_ms);
      const bool too_old = rules.max_age_s > 0 && age_ms > rules.max_age_s * 1000 && may_age > 0;
      const bool too_many = rules.max_jobs > 0 && finished > rules.max_jobs;
      const bool too_large = rules.max_bytes > 0 && totals.bytes > rules.max_bytes;
      if (!too_old && !too_many && !too_large) {
        remove_files();
        return removed;
      }
      store.erase(job.id);
      erased.push_back(job.id);
      totals.bytes -= job.model_bytes + job.result_bytes;
      --finished;
      if (too_old) --may_age;
    }
    remove_files();
  }
}

std::size_t remove_spent_models(const RetentionRules& rules,
                                JobStore& store,
                                const JobFiles& files) {
  if (rules.spent_model_age_s == 0) return 0;
  const std::int64_t before = store.clock_ms() - rules.spent_model_age_s * 1000;
  const auto spent = store.spent_models(before, kBatch);
  if (spent.empty()) return 0;
  // The rows first: a row without its model would be an error. Should they not be made to last, the models stay
  // until their jobs go.
  for (const Job& job : spent) store.forget_model(job.id);
  store.make_durable();
  for (const Job& job : spent) files.remove_model(job.id);
  return spent.size();
}

std::int64_t tidy_erased(JobStore& store, const JobFiles& files, std::int64_t mark) {
  const auto erased = store.erased_up_to(mark);
  if (!erased.empty()) store.make_durable();
  for (const std::string& id : erased) files.remove(id);
  return store.tidy(mark);
}

RetentionKeeper::RetentionKeeper(RetentionRules rules,
                                 JobStore& store,
                                 const JobFiles& files,
                                 Logger& logger)
    : rules_(rules),
      store_(store),
      files_(files),
      logger_(logger),
      thread_([this](const std::stop_token& stop) { work(stop); }) {
}

RetentionKeeper::~RetentionKeeper() = default;

void RetentionKeeper::poke() {
  {
    const std::lock_guard lock(mutex_);
    poked_ = true;
  }
  wake_.notify_one();
}

void RetentionKeeper::work(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, kInterval, [this] { return poked_; });
      poked_ = false;
    }
    if (stop.stop_requested()) return;
    try {
      const std::size_t removed = apply_retention(rules_, store_, files_);
      remove_spent_models(rules_, store_, files_);
      // Those of the sweep before: a worker lets go of its files within a second.
      if (const std::int64_t now = steady_ms(); now >= tidy_at_ms_) {
        tidy_at_ms_ = now + std::chrono::milliseconds(kInterval).count();
        erased_mark_ = tidy_erased(store_, files_, erased_mark_);
      }
      if (removed > 0) {
        logger_.info("jobs_expired", {{"count", static_cast<std::int64_t>(removed)}});
      }
    } catch (const std::exception& exception) {
      logger_.error("retention_failed", {{"what", exception.what()}});
    }
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, stop, kPause, [] { return false; });
  }
}

}  // namespace symcell::server
