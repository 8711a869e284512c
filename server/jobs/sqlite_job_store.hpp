// Jobs in an embedded SQLite database, whose write-ahead log is synchronised by make_durable(), once for all who
// ask for it together (server/jobs/sqlite_log.hpp).
//
// Opening migrates older schemas and refuses newer ones (server/jobs/sqlite_schema.hpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "server/base/clock.hpp"
#include "server/jobs/job_store.hpp"

namespace symcell::server {

// The machine's clocks, in milliseconds; tests have their own.
struct MachineClocks {
  std::function<std::int64_t()> wall = now_ms;
  std::function<std::int64_t()> steady = steady_ms;
};

class SqliteJobStore final : public JobStore {
 public:
  // Creates the file, for its owner alone, if it is missing.  `directory_id`: written to a database
  // that has none.  Throws std::runtime_error if the file is no database of ours or of a newer
  // version.
  explicit SqliteJobStore(const std::filesystem::path& file,
                          const std::string& directory_id = {},
                          MachineClocks clocks = {});
  ~SqliteJobStore() override;

  using JobStore::insert;
  InsertOutcome insert(const Job& job,
                       const std::optional<IdempotencyKey>& key,
                       const Admission& admission,
                       const std::vector<FileCopy>& copies) override;
  void make_durable() override;
  [[nodiscard]] bool keeps_copies() const override { return true; }
  [[nodiscard]] std::uint64_t copied_bytes() override;
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
  void check_health() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace symcell::server
