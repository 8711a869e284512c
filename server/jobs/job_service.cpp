#include "server/jobs/job_service.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "api/problem.hpp"
#include "api/schema/options.hpp"
#include "server/base/clock.hpp"
#include "server/base/files.hpp"
#include "server/base/identifiers.hpp"
#include "server/jobs/postgres_job_store.hpp"
#include "server/jobs/sqlite_job_store.hpp"
#include "server/jobs/staged_model.hpp"
#include "server/jobs/stored_files.hpp"
#include "server/jobs/watched_job_store.hpp"
#include "server/keys/postgres_key_store.hpp"
#include "server/keys/sqlite_key_store.hpp"

namespace symcell::server {
namespace {

std::string digest_of(const Submission& submission, const std::string& options_json) {
  Sha256 digest;
  digest.append(options_json);
  digest.append("\n");
  digest.append(model_format_info(submission.model_format).name);
  digest.append("\n");
  FileReader model(submission.model, Links::kRefuse);
  for (std::string_view piece = model.next(); !piece.empty(); piece = model.next()) {
    digest.append(piece);
  }
  return digest.finish();
}

JobChange failure(const Job& job, const std::string& message) {
  const Error error{ErrorCode::kInternal, message, {}, {}};
  return {.time_ms = now_ms(),
          .error_code = std::string(error_code_name(error.code)),
          .error_json = problem_document(error, "/v1/jobs/" + job.id, "/model").dump()};
}

// A row whose model cannot be had is taken back.
void settle_or_erase(JobStore& store, const JobFiles& files, const std::string& id) {
  try {
    settle_model(files, id);
  } catch (...) {
    store.erase(id);
    throw;
  }
}

// Models of servers that died, or lost their database, before they had a row for them. Younger ones may be
// another server's that is about to write it.
void remove_stale(const JobFiles& files, JobStore& store) {
  constexpr std::chrono::hours kStaleAge{24};
  const auto before = std::filesystem::file_time_type::clock::now() - kStaleAge;
  for (const auto& entry :
       std::filesystem::directory_iterator(files.database().parent_path() / "jobs")) {
    const auto id = staged_job(entry.path().filename().native());
    if (!id || !entry.is_directory() || entry.is_symlink()) continue;
    std::error_code error;
    if (entry.last_write_time(error) > before || error) continue;
    if (!store.find(*id)) discard_staged(files, *id);
  }
}

}  // namespace

JobService::JobService(const std::filesystem::path& data_directory,
                       const JobLimits& limits,
                       JobEngine& engine,
                       Metrics& metrics,
                       Logger& logger)
    : limits_(limits),
      engine_(engine),
      metrics_(metrics),
      logger_(logger),
      directory_(data_directory, logger, !limits.store_url.empty()),
      files_(directory_.path(), !limits.store_url.empty()) {
  JobRunner::declare_metrics(metrics_);
  std::unique_ptr<JobStore> store;
  if (limits_.store_url.empty()) {
    directory_.empty_incoming();
    store = std::make_unique<SqliteJobStore>(files_.database(), directory_.id());
    key_store_ = std::make_unique<SqliteKeyStore>(files_.database(), true);
  } else {
    store = std::make_unique<PostgresJobStore>(limits_.store_url, directory_.id());
    key_store_ = std::make_unique<PostgresKeyStore>(limits_.store_url);
  }
  store_ = std::make_unique<WatchedJobStore>(std::move(store), metrics_, logger_);
  key_ring_ = std::make_unique<KeyRing>(*key_store_, logger_);
  runner_ = std::make_unique<JobRunner>(
      RunnerParts{engine_, *store_, files_, faults_, changes_, metrics_, logger_}, limits_.workers);
}

JobService::~JobService() {
  // Without a stop before, jobs that run are cancelled and queued for the next start.
  if (!stopping_) static_cast<void>(finish_stop(std::chrono::milliseconds(0)));
  retention_.reset();
  runner_.reset();
  copies_.reset();
  store_.reset();
}

void JobService::start() {
  // What others are about to store, or run, would look like what a dead server left.
  if (store_->shared()) {
    remove_stale(files_, *store_);
  } else {
    take_up_what_was_left();
  }
  if (store_->keeps_copies()) copies_ = std::make_unique<CopyKeeper>(*store_, files_, logger_);
  runner_->start();
  retention_ = std::make_unique<RetentionKeeper>(limits_.retention, *store_, files_, logger_);
}

void JobService::take_up_what_was_left() {
  using Fate = DataDirectory::Fate;
  // What the last server erased, and perhaps not for good: files go when it lasts.
  store_->make_durable();
  directory_.sweep_jobs(
      [this](const std::string& id) {
        if (const auto staged = staged_job(id)) {
          if (!store_->find(*staged)) return Fate::kRemove;
          settle_model(files_, *staged);
          return Fate::kKeep;
        }
        if (store_->find(id)) return Fate::kKeep;
        return store_->was_erased(id) ? Fate::kRemove : Fate::kUnknown;
      },
      [this](const std::string& id) { files_.remove(id); });
  restore_copies(*store_, files_, logger_);
  store_->tidy(std::numeric_limits<std::int64_t>::max());
  for (const Job& job : store_->unfinished()) recover(job);
  store_->make_durable();
}

void JobService::recover(const Job& job) {
  if (!std::filesystem::exists(files_.model(job.id))) {
    store_->apply(job.id, JobEvent::kFail, failure(job, "the model's file is lost"));
    return;
  }
  // A death of the server says nothing of the job: it meshes in a process of its own, whose ends are
  // counted.
  if (job.state == JobState::kRunning) {
    store_->apply(job.id, JobEvent::kRequeue, {.time_ms = now_ms()});
  }
  logger_.info("job_recovered", {{"job", job.id}});
}

void JobService::begin_stop() {
  stopping_ = true;
  changes_.notify_all();
}

bool JobService::finish_stop(std::chrono::milliseconds grace) {
  begin_stop();
  return runner_->stop(grace);
}

MeshOptions JobService::capped(MeshOptions options) const {
  options.time_limit_s = std::min(options.time_limit_s, limits_.time_limit_s);
  options.max_elements = std::min(options.max_elements, limits_.max_elements);
  return options;
}

// A queue of ten places or more keeps a tenth that no client takes alone, so that others find room.
Admission JobService::admission(const KeyLimits& limits) const {
  constexpr std::size_t kShareForOthers = 10;
  const std::size_t limit = limits_.queue_limit;
  Admission most;
  most.queued = static_cast<std::int64_t>(limit);
  most.queued_of_client = static_cast<std::int64_t>(limit - limit / kShareForOthers);
  if (limits.queued > 0) most.queued_of_client = std::min(most.queued_of_client, limits.queued);
  if (limits.bytes_per_day > 0) most.bytes_per_day = limits.bytes_per_day;
  return most;
}

ClientUsage JobService::usage(std::string_view client) {
  return store_->usage(client, now_ms());
}

bool JobService::queue_is_full(const std::string& client, const KeyLimits& limits) {
  const Admission most = admission(limits);
  const StoreTotals totals = store_->totals();
  return totals.by_state[static_cast<std::size_t>(JobState::kQueued)] >= most.queued ||
         usage(client).queued >= most.queued_of_client;
}

SubmitOutcome JobService::submit(const Submission& submission) {
  return submit_options(submission, options_to_json(capped(submission.options),
                                                    model_format_info(submission.model_format).kind)
                                        .dump());
}

SubmitOutcome JobService::submit_options(const Submission& submission,
                                         const std::string& options_json) {
  std::optional<IdempotencyKey> key;
  if (!submission.idempotency_key.empty()) {
    key = {submission.idempotency_key, digest_of(submission, options_json), submission.owner};
    // Before the queue is asked: a repeated request gets its job however full the queue is.
    if (auto known = store_->find_key(*key)) {
      const bool same = known->result == InsertResult::kReplayed;
      if (!submission.durable_soon || end_is_unsettled(known->job)) make_durable();
      return {same ? SubmitStatus::kReplayed : SubmitStatus::kKeyConflict, std::move(known->job)};
    }
  }
  if (stopping_) return {SubmitStatus::kStopping, {}};
  SubmitOutcome outcome = store_job(submission, key, options_json);
  if (outcome.status == SubmitStatus::kAccepted) {
    runner_->poke();
    if (retention_) retention_->poke();
    if (copies_) copies_->poke();
  }
  // Beside the run, which may have begun.
  if (!submission.durable_soon || end_is_unsettled(outcome.job)) make_durable();
  return outcome;
}

// Hard-linked rather than copied: models are never written to again.
SubmitOutcome JobService::rerun(const Job& job, Submission submission) {
  check_model(job, files_);
  submission.model = files_.incoming();
  std::filesystem::create_hard_link(files_.model(job.id), submission.model);
  submission.model_format = job.model_format;
  submission.model_name = job.model_name;
  try {
    SubmitOutcome outcome = submit_options(submission, job.options_json);
    std::error_code ignored;
    std::filesystem::remove(submission.model, ignored);
    return outcome;
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(submission.model, ignored);
    throw;
  }
}

SubmitOutcome JobService::store_job(const Submission& submission,
                                    const std::optional<IdempotencyKey>& key,
                                    const std::string& options_json) {
  Job job;
  job.created_ms = now_ms();
  job.id = make_job_id(job.created_ms);
  job.model_format = submission.model_format;
  job.model_name = submission.model_name;
  job.options_json = options_json;
  job.client = submission.client;
  job.owner = submission.owner;
  job.most_running = submission.limits.running;
  job.weight = submission.priority;
  job.request_id = submission.request_id;
  job.traceparent = submission.traceparent;
  job.webhook = submission.webhook;
  const std::uintmax_t bytes = std::filesystem::file_size(submission.model);
  job.model_bytes = static_cast<std::int64_t>(bytes);
  std::vector<FileCopy> copies;
  if (store_->keeps_copies() && bytes <= kSmallFileBytes) {
    copies.push_back({"model", std::string(MappedFile(submission.model, Links::kRefuse).bytes())});
    job.model_sha256 = sha256_of(copies.front().bytes);
  } else {
    job.model_sha256 = sha256_of_file(submission.model);
  }
  bool has_row = false;
  try {
    files_.adopt_model(submission.model, job.id, copies.empty());
    InsertOutcome inserted = store_->insert(job, key, admission(submission.limits), copies);
    has_row = inserted.result == InsertResult::kInserted;
    if (has_row) {
      settle_or_erase(*store_, files_, job.id);
    } else {
      discard_staged(files_, job.id);
    }
    switch (inserted.result) {
      case InsertResult::kInserted: return {SubmitStatus::kAccepted, std::move(inserted.job)};
      case InsertResult::kReplayed: return {SubmitStatus::kReplayed, std::move(inserted.job)};
      case InsertResult::kConflict: return {SubmitStatus::kKeyConflict, {}};
      case InsertResult::kQueueFull: return {SubmitStatus::kQueueFull, {}};
      case InsertResult::kBytesSpent: return {SubmitStatus::kBytesSpent, {}};
    }
  } catch (const StoreError&) {
    // A database that went away may have the row. Then the job will be asked for again, by its key for
    // instance, and run; else remove_stale() has the model.
    if (!store_->shared() && !has_row) discard_staged(files_, job.id);
    throw;
  } catch (...) {
    discard_staged(files_, job.id);
    throw;
  }
  return {SubmitStatus::kKeyConflict, {}};
}

bool JobService::end_is_unsettled(const Job& job) const {
  return is_finished(job.state) && runner_->progress(job.id);
}

std::optional<Job> JobService::find(std::string_view id) {
  if (!is_job_id(id)) return std::nullopt;
  auto job = store_->find(id);
  if (job && end_is_unsettled(*job)) make_durable();
  return job;
}

std::vector<Job> JobService::list(const JobFilter& filter) {
  auto jobs = store_->list(filter);
  if (std::ranges::any_of(jobs, [this](const Job& job) { return end_is_unsettled(job); })) {
    make_durable();
  }
  return jobs;
}

std::optional<Progress> JobService::progress(const Job& job) const {
  if (auto own = runner_->progress(job.id)) return own;
  return job.state == JobState::kRunning ? job.progress : std::nullopt;
}

std::uint64_t JobService::free_bytes() const {
  std::error_code error;
  const auto space = std::filesystem::space(files_.incoming().parent_path(), error);
  return error ? 0 : space.available;
}

std::string JobService::fault() const {
  // Less than the largest body that may come, by default.
  constexpr std::uint64_t kLeastFreeBytes = std::uint64_t{64} << 20U;
  if (const std::uint64_t free = free_bytes(); free < kLeastFreeBytes) {
    return "there are " + std::to_string(free >> 20U) + " MiB left on the disk";
  }
  if (const std::size_t overdue = runner_->overdue(); overdue > 0) {
    return std::to_string(overdue) + " jobs run beyond their time limit and do not end";
  }
  return {};
}

double JobService::queue_age_s() {
  const auto oldest = store_->oldest_waiting_ms();
  return oldest ? static_cast<double>(std::max<std::int64_t>(0, now_ms() - *oldest)) / 1000 : 0;
}

std::optional<Job> JobService::cancel(std::string_view id) {
  auto job = find(id);
  if (!job || is_finished(job->state)) return job;
  if (job->state == JobState::kQueued &&
      store_->apply(id, JobEvent::kCancel, {.time_ms = now_ms(), .attempt = job->attempt})) {
    logger_.info("job_cancelled_in_queue", {{"job", id}});
    try {
      make_durable();
    } catch (const StoreError&) {
      changes_.notify(id);
      throw;
    }
    changes_.notify(id);
    return find(id);
  }
  // It runs, or was started just now.
  if (runner_->cancel(id) == JobRunner::CancelResult::kNotHere && store_->shared()) {
    store_->request_cancel(id);
  }
  return find(id);
}

bool JobService::erase(std::string_view id) {
  if (!is_job_id(id)) return false;
  const auto job = store_->find(id);
  if (!store_->erase(id)) return false;
  runner_->cancel(id);
  changes_.notify(id);
  logger_.info("job_deleted", {{"job", id}});
  faults_.remove(id);  // nothing refers to it
  make_durable();
  // Where another server runs it, that one removes the files.
  const bool elsewhere = store_->shared() && job && job->state == JobState::kRunning;
  // A worker that still holds the job removes the files when it lets go and finds the row gone.
  if (!elsewhere && !runner_->progress(id)) files_.remove(id);
  return true;
}

}  // namespace symcell::server
