// Jobs in an embedded SQLite database: write-ahead log, synchronised at every commit.
//
// The schema carries a version (PRAGMA user_version); opening migrates older ones step by step and
// refuses newer ones.
#pragma once

#include <filesystem>
#include <memory>

#include "server/jobs/job_store.hpp"

namespace symcell::server {

class SqliteJobStore final : public JobStore {
 public:
  // Throws std::runtime_error if the file is no database of ours or of a newer version.
  explicit SqliteJobStore(const std::filesystem::path& file);
  ~SqliteJobStore() override;

  InsertOutcome insert(const Job& job, const std::optional<IdempotencyKey>& key) override;
  [[nodiscard]] std::optional<InsertOutcome> find_key(const IdempotencyKey& key) override;
  [[nodiscard]] std::optional<Job> find(std::string_view id) override;
  [[nodiscard]] std::vector<Job> list(const JobFilter& filter) override;
  [[nodiscard]] std::vector<Job> unfinished() override;
  [[nodiscard]] std::vector<Job> oldest_finished(std::size_t limit) override;
  std::optional<Job> apply(std::string_view id, JobEvent event, const JobChange& change) override;
  bool erase(std::string_view id) override;
  [[nodiscard]] StoreTotals totals() override;
  void check_health() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace symcell::server
