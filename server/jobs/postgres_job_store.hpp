// Jobs in a PostgreSQL database that any number of servers share.
//
// Times are the database's alone. A run belongs to the server that claimed it as long as that server
// renews its lease; one whose lease has ended is queued again, and what its former server still
// writes bears an older attempt and is not taken. Servers tell each other of changes by NOTIFY, and
// look for themselves every few seconds, for word may be lost.
#pragma once

#include <memory>
#include <string>

#include "server/jobs/job_store.hpp"

namespace symcell::server {

class PostgresConnections;

class PostgresJobStore final : public JobStore {
 public:
  // Throws StoreError if the database cannot be reached, std::runtime_error if its tables are of a
  // newer version or it has another `directory_id`, which is written where it has none.
  PostgresJobStore(const std::string& url, const std::string& directory_id);
  ~PostgresJobStore() override;

  using JobStore::insert;
  InsertOutcome insert(const Job& job,
                       const std::optional<IdempotencyKey>& key,
                       const Admission& admission,
                       const std::vector<FileCopy>& copies) override;
  [[nodiscard]] std::optional<InsertOutcome> find_key(const IdempotencyKey& key) override;
  [[nodiscard]] std::optional<Job> find(std::string_view id) override;
  [[nodiscard]] std::vector<Job> list(const JobFilter& filter) override;
  [[nodiscard]] std::vector<Job> unfinished() override;
  [[nodiscard]] std::vector<Job> oldest_finished(std::size_t limit) override;
  [[nodiscard]] ClientUsage usage(std::string_view client, std::int64_t time_ms) override;
  std::optional<Job> claim(std::int64_t time_ms) override;
  [[nodiscard]] bool shared() const override { return true; }
  [[nodiscard]] std::vector<RunOrder> keep(const std::vector<RunState>& runs) override;
  std::size_t rescue() override;
  void request_cancel(std::string_view id) override;
  void listen(const std::function<void(std::string_view id)>& changed) override;
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
  std::int64_t tidy(std::int64_t mark) override;
  [[nodiscard]] std::int64_t clock_ms() override;
  // As of a second ago, finished ones of half a minute.
  [[nodiscard]] StoreTotals totals() override;
  void check_health() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace symcell::server
