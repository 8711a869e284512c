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
#include "server/jobs/copy_keeper.hpp"
#include "server/jobs/data_directory.hpp"
#include "server/jobs/job_engine.hpp"
#include "server/jobs/job_files.hpp"
#include "server/jobs/job_runner.hpp"
#include "server/jobs/job_store.hpp"
#include "server/jobs/retention.hpp"
#include "server/keys/key_ring.hpp"

namespace symcell::server {

struct JobLimits {
  std::size_t workers = 1;
  std::size_t queue_limit = 100;
  double time_limit_s = kInfinity;  // caps of the server on every job
  std::uint64_t max_elements = 50'000'000;
  RetentionRules retention;
  // postgres://...: servers that share their jobs, and their data directory for models and results;
  // empty: a database of this server's alone, in its data directory.
  std::string store_url = {};
};

struct Submission {
  std::filesystem::path model;  // an arrived file under `incoming`; moved if the job is accepted
  ModelFormat model_format = ModelFormat::kPslgJson;
  std::string model_name;
  MeshOptions options;
  std::string idempotency_key;  // empty: none
  std::string client = {};      // whose it is: clients take turns
  std::string owner = {};       // the id of the client's key, if it has one
  KeyLimits limits = {};        // of that key
  std::int32_t priority = 1;
  std::string request_id = {};
  std::string traceparent = {};
  std::string webhook = {};
  // Whoever asks for this calls make_durable() before anybody is told that the job was accepted, or waits
  // for its end, which is durable.
  bool durable_soon = false;
};

enum class SubmitStatus : std::uint8_t {
  kAccepted,
  kReplayed,
  kKeyConflict,
  kQueueFull,
  kBytesSpent,
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
  void make_durable() { store_->make_durable(); }
  // The same model and options again, of which `submission` has all but these two.
  [[nodiscard]] SubmitOutcome rerun(const Job& job, Submission submission);
  // True if a submission of this client without a known key would be refused now.
  [[nodiscard]] bool queue_is_full(const std::string& client = {}, const KeyLimits& limits = {});

  [[nodiscard]] std::optional<Job> find(std::string_view id);
  [[nodiscard]] std::vector<Job> list(const JobFilter& filter);
  [[nodiscard]] std::optional<Progress> progress(const Job& job) const;

  // nullopt: unknown. A finished job stays as it is; a running one is cancelled within a second.
  std::optional<Job> cancel(std::string_view id);
  // Forgets the job at once; if it runs, its worker stops within a second. False: unknown. StoreError: it is not
  // forgotten, or not for sure; then its files go later.
  bool erase(std::string_view id);

  [[nodiscard]] const JobFiles& files() const { return files_; }
  [[nodiscard]] const ChangeSignal& changes() const { return changes_; }
  [[nodiscard]] JobEngine& engine() { return engine_; }
  [[nodiscard]] const JobLimits& limits() const { return limits_; }
  [[nodiscard]] const JobRunner& runner() const { return *runner_; }
  [[nodiscard]] KeyRing& keys() { return *key_ring_; }
  [[nodiscard]] ClientUsage usage(std::string_view client);
  [[nodiscard]] StoreTotals totals() { return store_->totals(); }
  void check_health() { store_->check_health(); }
  // What else than the store keeps it from running jobs well: no room on the disk, a run that does
  // not end. Empty: nothing.
  [[nodiscard]] std::string fault() const;
  // Seconds that the job waits which waits longest.
  [[nodiscard]] double queue_age_s();
  [[nodiscard]] JobStore& store() { return *store_; }
  // Room for files, in bytes.
  [[nodiscard]] std::uint64_t free_bytes() const;
  // The server's caps applied to what a request asks for.
  [[nodiscard]] MeshOptions capped(MeshOptions options) const;

 private:
  void take_up_what_was_left();
  void recover(const Job& job);
  // Nobody is shown an end that a failure of the machine might undo.
  [[nodiscard]] bool end_is_unsettled(const Job& job) const;
  [[nodiscard]] Admission admission(const KeyLimits& limits) const;
  [[nodiscard]] SubmitOutcome submit_options(const Submission& submission,
                                             const std::string& options_json);
  [[nodiscard]] SubmitOutcome store_job(const Submission& submission,
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
  std::unique_ptr<KeyStore> key_store_;
  std::unique_ptr<KeyRing> key_ring_;
  std::unique_ptr<JobRunner> runner_;
  std::unique_ptr<RetentionKeeper> retention_;
  std::unique_ptr<CopyKeeper> copies_;
  std::atomic<bool> stopping_{false};
};

}  // namespace symcell::server
