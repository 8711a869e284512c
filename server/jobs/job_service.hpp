// Jobs as the handlers see them: accept, look up, wait, cancel, delete. Store, files, queue and
// retention lie behind it.
//
// Guarantees: an accepted job's model and row are durable before `submit` returns; a server that
// opens the same data directory later finds every finished job and runs every unfinished one again.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"
#include "server/jobs/change_signal.hpp"
#include "server/jobs/data_directory.hpp"
#include "server/jobs/job_engine.hpp"
#include "server/jobs/job_files.hpp"
#include "server/jobs/job_runner.hpp"
#include "server/jobs/job_store.hpp"
#include "server/jobs/retention.hpp"

namespace symcell::server {

struct JobLimits {
  std::size_t workers = 1;
  std::size_t queue_limit = 100;
  double time_limit_s = kInfinity;  // caps of the server on every job
  std::uint64_t max_elements = 50'000'000;
  RetentionRules retention;
};

struct Submission {
  std::filesystem::path model;  // an arrived file under `incoming`; moved if the job is accepted
  ModelFormat model_format = ModelFormat::kPslgJson;
  std::string model_name;
  MeshOptions options;
  std::string idempotency_key;  // empty: none
  std::string client = {};      // whose it is: clients take turns
};

enum class SubmitStatus : std::uint8_t {
  kAccepted,
  kReplayed,
  kKeyConflict,
  kQueueFull,
  kStopping
};

struct SubmitOutcome {
  SubmitStatus status = SubmitStatus::kAccepted;
  Job job;  // of kAccepted and kReplayed
};

class JobService {
 public:
  // Takes the directory and opens or creates the store in it; throws std::runtime_error where
  // DataDirectory does. No job runs before start().
  JobService(const std::filesystem::path& data_directory,
             const JobLimits& limits,
             JobEngine& engine,
             Metrics& metrics,
             Logger& logger);
  ~JobService();

  // Takes up the unfinished jobs of an earlier run.
  void start();
  // From now on submissions are refused and waits end; running jobs go on.
  void begin_stop();
  [[nodiscard]] bool stopping() const { return stopping_; }
  // See JobRunner::stop.
  [[nodiscard]] bool finish_stop(std::chrono::milliseconds grace);

  [[nodiscard]] SubmitOutcome submit(const Submission& submission);
  // True if a submission of this client without a known key would be refused now.
  [[nodiscard]] bool queue_is_full(const std::string& client = {});

  [[nodiscard]] std::optional<Job> find(std::string_view id);
  [[nodiscard]] std::vector<Job> list(const JobFilter& filter) { return store_->list(filter); }
  // The job once it is finished, or as it is at the deadline or when the server stops.
  [[nodiscard]] std::optional<Job> wait_finished(std::string_view id,
                                                 ChangeSignal::Clock::time_point deadline);
  [[nodiscard]] std::optional<Progress> progress(std::string_view id) const;

  // nullopt: unknown. A finished job stays as it is; a running one is cancelled within a second.
  std::optional<Job> cancel(std::string_view id);
  // Forgets the job at once; if it runs, its worker stops within a second. False: unknown.
  bool erase(std::string_view id);

  [[nodiscard]] const JobFiles& files() const { return files_; }
  [[nodiscard]] const ChangeSignal& changes() const { return changes_; }
  [[nodiscard]] JobEngine& engine() { return engine_; }
  [[nodiscard]] const JobLimits& limits() const { return limits_; }
  [[nodiscard]] const JobRunner& runner() const { return *runner_; }
  [[nodiscard]] StoreTotals totals() { return store_->totals(); }
  void check_health() { store_->check_health(); }
  // The server's caps applied to what a request asks for.
  [[nodiscard]] MeshOptions capped(MeshOptions options) const;

 private:
  void recover(const Job& job);
  [[nodiscard]] Admission admission() const;
  [[nodiscard]] SubmitOutcome store(const Submission& submission,
                                    const std::optional<IdempotencyKey>& key,
                                    const std::string& options_json);

  JobLimits limits_;
  JobEngine& engine_;
  Metrics& metrics_;
  Logger& logger_;
  DataDirectory directory_;
  JobFiles files_;
  FaultArchive faults_{files_.faults()};
  ChangeSignal changes_;
  std::unique_ptr<JobStore> store_;
  std::unique_ptr<JobRunner> runner_;
  std::unique_ptr<RetentionKeeper> retention_;
  std::atomic<bool> stopping_{false};
};

}  // namespace symcell::server
