// A store that is watched: its failures are counted, told in the log, and remembered until it works
// again.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>

#include "server/base/log.hpp"
#include "server/base/metrics.hpp"
#include "server/jobs/job_store.hpp"

namespace symcell::server {

class WatchedJobStore final : public JobStore {
 public:
  // Counts symcell_store_errors_total; declares it. Both must outlive the store.
  WatchedJobStore(std::unique_ptr<JobStore> store, Metrics& metrics, Logger& logger);

  using JobStore::insert;
  InsertOutcome insert(const Job& job,
                       const std::optional<IdempotencyKey>& key,
                       const Admission& admission,
                       const std::vector<FileCopy>& copies) override;
  void make_durable() override;
  [[nodiscard]] bool keeps_copies() const override { return store_->keeps_copies(); }
  [[nodiscard]] std::uint64_t copied_bytes() override { return store_->copied_bytes(); }
  [[nodiscard]] std::int64_t newest_copy() override;
  [[nodiscard]] std::optional<FileCopy> copy_after(std::int64_t number) override;
  void forget_copies(std::int64_t number) override;
  [[nodiscard]] std::optional<InsertOutcome> find_key(const IdempotencyKey& key) override;
  [[nodiscard]] std::optional<Job> find(std::string_view id) override;
  [[nodiscard]] std::vector<Job> list(const JobFilter& filter) override;
  [[nodiscard]] std::vector<Job> unfinished() override;
  [[nodiscard]] std::vector<Job> oldest_finished(std::size_t limit) override;
  [[nodiscard]] ClientUsage usage(std::string_view client, std::int64_t time_ms) override;
  std::optional<Job> claim(std::int64_t time_ms) override;
  [[nodiscard]] bool shared() const override { return store_->shared(); }
  [[nodiscard]] std::vector<RunOrder> keep(const std::vector<RunState>& runs) override;
  std::size_t rescue() override;
  void request_cancel(std::string_view id) override;
  void listen(const std::function<void(std::string_view id)>& changed) override {
    store_->listen(changed);
  }
  [[nodiscard]] std::optional<std::int64_t> oldest_waiting_ms() override;
  [[nodiscard]] std::vector<Job> spent_models(std::int64_t before_clock_ms,
                                              std::size_t limit) override;
  void forget_model(std::string_view id) override;
  std::optional<Delivery> claim_delivery(std::chrono::milliseconds patience) override;
  void delivered(std::string_view job_id) override;
  void delivery_failed(std::string_view job_id,
                       std::optional<std::chrono::milliseconds> pause) override;
  std::optional<Job> apply(std::string_view id, JobEvent event, const JobChange& change) override;
  void count_lost_worker(std::string_view id) override;
  bool erase(std::string_view id) override;
  [[nodiscard]] bool was_erased(std::string_view id) override;
  [[nodiscard]] std::vector<std::string> erased_up_to(std::int64_t mark) override;
  std::int64_t tidy(std::int64_t mark) override;
  [[nodiscard]] std::int64_t clock_ms() override;
  [[nodiscard]] StoreTotals totals() override;
  // Asks the store at most every few seconds while it works, and every time while it fails.
  void check_health() override;

 private:
  using Clock = std::chrono::steady_clock;

  template <class Work>
  auto watched(std::string_view operation, bool writes, const Work& work);
  void failed(std::string_view operation, const std::exception& exception);
  // Something was written, and is known to last after the next make_durable(): only that says that the store works.
  void committed();
  void wrote();

  std::unique_ptr<JobStore> store_;
  Metrics& metrics_;
  Logger& logger_;
  std::mutex mutex_;        // guards all below
  bool committed_ = false;  // since the last make_durable()
  bool failing_ = false;
  std::uint64_t failures_ = 0;  // since it began to fail
  Clock::time_point told_{};
  Clock::time_point last_write_{};
};

}  // namespace symcell::server
