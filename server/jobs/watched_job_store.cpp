#include "server/jobs/watched_job_store.hpp"

#include <exception>
#include <type_traits>
#include <utility>

namespace symcell::server {
namespace {

// A store that fails does so for everybody who asks; one line tells as much as a hundred.
constexpr std::chrono::seconds kTellInterval{10};
// A probe costs a commit, and a write that succeeded as lately as this is as good.
constexpr std::chrono::seconds kHealthyFor{5};

}  // namespace

WatchedJobStore::WatchedJobStore(std::unique_ptr<JobStore> store, Metrics& metrics, Logger& logger)
    : store_(std::move(store)), metrics_(metrics), logger_(logger) {
  metrics_.declare_counter("symcell_store_errors_total",
                           "Calls to the job store that failed, by operation.");
}

void WatchedJobStore::failed(std::string_view operation, const std::exception& exception) {
  metrics_.count("symcell_store_errors_total", {{"operation", operation}});
  const std::lock_guard lock(mutex_);
  ++failures_;
  const bool first = !std::exchange(failing_, true);
  if (!first && Clock::now() - told_ < kTellInterval) return;
  told_ = Clock::now();
  logger_.error("store_failed", {{"operation", operation},
                                 {"what", exception.what()},
                                 {"failures", static_cast<std::int64_t>(failures_)}});
}

void WatchedJobStore::committed() {
  const std::lock_guard lock(mutex_);
  committed_ = true;
}

void WatchedJobStore::wrote() {
  const std::lock_guard lock(mutex_);
  last_write_ = Clock::now();
  if (!std::exchange(failing_, false)) return;
  logger_.info("store_works_again",
               {{"failures", static_cast<std::int64_t>(std::exchange(failures_, 0))}});
}

template <class Work>
auto WatchedJobStore::watched(std::string_view operation, bool writes, const Work& work) {
  try {
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      if (writes) committed();
    } else {
      auto result = work();
      // What only reads says nothing of a disk that is full.
      if (writes) committed();
      return result;
    }
  } catch (const std::exception& exception) {
    failed(operation, exception);
    throw;
  }
}

InsertOutcome WatchedJobStore::insert(const Job& job,
                                      const std::optional<IdempotencyKey>& key,
                                      const Admission& admission,
                                      const std::vector<FileCopy>& copies) {
  return watched("insert", true, [&] { return store_->insert(job, key, admission, copies); });
}

void WatchedJobStore::make_durable() {
  // Taken before: what another thread commits meanwhile may not be among what lasts.
  const bool committed = [&] {
    const std::lock_guard lock(mutex_);
    return std::exchange(committed_, false);
  }();
  try {
    watched("make_durable", false, [&] { store_->make_durable(); });
  } catch (...) {
    const std::lock_guard lock(mutex_);
    committed_ = committed_ || committed;
    throw;
  }
  if (committed) wrote();
}

std::int64_t WatchedJobStore::newest_copy() {
  return watched("newest_copy", false, [&] { return store_->newest_copy(); });
}

std::optional<FileCopy> WatchedJobStore::copy_after(std::int64_t number) {
  return watched("copy_after", false, [&] { return store_->copy_after(number); });
}

void WatchedJobStore::forget_copies(std::int64_t number) {
  watched("forget_copies", true, [&] { store_->forget_copies(number); });
}

ClientUsage WatchedJobStore::usage(std::string_view client, std::int64_t time_ms) {
  return watched("usage", false, [&] { return store_->usage(client, time_ms); });
}

std::optional<Job> WatchedJobStore::claim(std::int64_t time_ms) {
  // Finding nothing to start writes nothing.
  auto job = watched("claim", false, [&] { return store_->claim(time_ms); });
  if (job) committed();
  return job;
}

std::optional<InsertOutcome> WatchedJobStore::find_key(const IdempotencyKey& key) {
  return watched("find_key", false, [&] { return store_->find_key(key); });
}

std::optional<Job> WatchedJobStore::find(std::string_view id) {
  return watched("find", false, [&] { return store_->find(id); });
}

std::vector<Job> WatchedJobStore::list(const JobFilter& filter) {
  return watched("list", false, [&] { return store_->list(filter); });
}

std::vector<Job> WatchedJobStore::unfinished() {
  return watched("unfinished", false, [&] { return store_->unfinished(); });
}

std::vector<Job> WatchedJobStore::oldest_finished(std::size_t limit) {
  return watched("oldest_finished", false, [&] { return store_->oldest_finished(limit); });
}

std::vector<RunOrder> WatchedJobStore::keep(const std::vector<RunState>& runs) {
  return watched("keep", true, [&] { return store_->keep(runs); });
}

std::size_t WatchedJobStore::rescue() {
  return watched("rescue", true, [&] { return store_->rescue(); });
}

void WatchedJobStore::request_cancel(std::string_view id) {
  watched("request_cancel", true, [&] { store_->request_cancel(id); });
}

std::optional<std::int64_t> WatchedJobStore::oldest_waiting_ms() {
  return watched("oldest_waiting", false, [&] { return store_->oldest_waiting_ms(); });
}

std::vector<Job> WatchedJobStore::spent_models(std::int64_t before_clock_ms, std::size_t limit) {
  return watched("spent_models", false,
                 [&] { return store_->spent_models(before_clock_ms, limit); });
}

void WatchedJobStore::forget_model(std::string_view id) {
  watched("forget_model", true, [&] { store_->forget_model(id); });
}

std::optional<Delivery> WatchedJobStore::claim_delivery(std::chrono::milliseconds patience) {
  return watched("claim_delivery", false, [&] { return store_->claim_delivery(patience); });
}

void WatchedJobStore::delivered(std::string_view job_id) {
  watched("delivered", true, [&] { store_->delivered(job_id); });
}

void WatchedJobStore::delivery_failed(std::string_view job_id,
                                      std::optional<std::chrono::milliseconds> pause) {
  watched("delivery_failed", true, [&] { store_->delivery_failed(job_id, pause); });
}

std::optional<Job> WatchedJobStore::apply(std::string_view id,
                                          JobEvent event,
                                          const JobChange& change) {
  return watched("apply", true, [&] { return store_->apply(id, event, change); });
}

void WatchedJobStore::count_lost_worker(std::string_view id) {
  watched("count_lost_worker", true, [&] { store_->count_lost_worker(id); });
}

bool WatchedJobStore::erase(std::string_view id) {
  return watched("erase", true, [&] { return store_->erase(id); });
}

bool WatchedJobStore::was_erased(std::string_view id) {
  return watched("was_erased", false, [&] { return store_->was_erased(id); });
}

std::vector<std::string> WatchedJobStore::erased_up_to(std::int64_t mark) {
  return watched("erased_up_to", false, [&] { return store_->erased_up_to(mark); });
}

std::int64_t WatchedJobStore::tidy(std::int64_t mark) {
  return watched("tidy", true, [&] { return store_->tidy(mark); });
}

std::int64_t WatchedJobStore::clock_ms() {
  return store_->clock_ms();
}

StoreTotals WatchedJobStore::totals() {
  return store_->totals();
}

void WatchedJobStore::check_health() {
  {
    const std::lock_guard lock(mutex_);
    if (!failing_ && Clock::now() - last_write_ < kHealthyFor) return;
  }
  watched("probe", false, [&] { store_->check_health(); });
  wrote();
}

}  // namespace symcell::server
