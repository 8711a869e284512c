#include "server/jobs/job_runner.hpp"

#include <algorithm>
#include <cerrno>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "api/problem.hpp"
#include "api/schema/options.hpp"
#include "server/base/clock.hpp"
#include "server/base/files.hpp"
#include "server/base/identifiers.hpp"
#include "server/jobs/copy_keeper.hpp"
#include "server/jobs/staged_model.hpp"
#include "server/jobs/stored_files.hpp"

namespace symcell::server {
namespace {

// How long a cancelled engine may take before stop() gives it up; it promises one second.
constexpr std::chrono::seconds kCancelPatience{5};

// How often a shared store is asked for jobs that nobody told of, and told of runs (a lease is 15 s).
constexpr std::chrono::seconds kPollInterval{5};
constexpr std::chrono::milliseconds kKeepInterval{1000};
// What a job may take beyond its time limit: the engine kills its process within a second.
constexpr double kOverdueSeconds = 60;
// Between two runs of a job whose results the disk did not take: each costs the whole work.
constexpr std::chrono::milliseconds kFirstMeshPause{500};
constexpr std::chrono::milliseconds kLongestMeshPause{30'000};
// Between two tries of what the store or the disk refused.
constexpr std::chrono::milliseconds kFirstPause{50};
constexpr std::chrono::milliseconds kLongestPause{1000};

// What passes when the cause is gone, unlike a file that is missing.
bool may_pass(const std::system_error& error) {
  if (error.code().category() != std::generic_category()) return false;
  switch (error.code().value()) {
    case ENOSPC:
    case EDQUOT:
    case EROFS:
    case EIO:
    case ENOMEM:
    case EMFILE:
    case ENFILE: return true;
    default: return false;
  }
}

// Also after a try that came half way. Whoever calls makes it last.
void name_file(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::rename(JobFiles::partial(file), file, error);
  if (error && !std::filesystem::exists(file)) {
    throw std::system_error(error.value(), std::generic_category(), file.string());
  }
}

std::int64_t file_bytes(const std::filesystem::path& file) {
  return static_cast<std::int64_t>(std::filesystem::file_size(file));
}

}  // namespace

JobRunner::JobRunner(RunnerParts parts, std::size_t workers) : parts_(parts), workers_(workers) {
}

void JobRunner::declare_metrics(Metrics& metrics) {
  metrics.declare_counter("symcell_job_errors_total", "Failed jobs by error code.");
  metrics.declare_histogram("symcell_job_duration_seconds",
                            "Time jobs ran, by the state they ended in.",
                            {0.01, 0.05, 0.25, 1, 5, 30, 120, 600, 3600});
  metrics.declare_histogram("symcell_job_wait_seconds", "Time jobs waited before they ran.",
                            {0.01, 0.05, 0.25, 1, 5, 30, 120, 600, 3600});
  metrics.declare_histogram("symcell_phase_duration_seconds",
                            "Time of a phase of a job that succeeded.",
                            {0.001, 0.01, 0.05, 0.25, 1, 5, 30, 120, 600, 3600});
  metrics.declare_counter("symcell_elements_total",
                          "Elements of the cells of jobs that succeeded.");
  metrics.declare_counter("symcell_job_write_retries_total",
                          "Times that a job's state or results could not be written and were tried "
                          "again.");
  metrics.declare_counter("symcell_jobs_rescued_total",
                          "Runs queued again because their server gave no sign of life.");
  metrics.declare_counter("symcell_internal_errors_total", "Bugs and failures of the machine.");
}

JobRunner::~JobRunner() {
  if (parts_.store.shared()) parts_.store.listen(nullptr);
  static_cast<void>(stop(std::chrono::milliseconds(0)));
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
  if (keeper_.joinable()) keeper_.join();
}

void JobRunner::start() {
  threads_.reserve(workers_);
  for (std::size_t i = 0; i < workers_; ++i) threads_.emplace_back([this] { work(); });
  if (!parts_.store.shared()) return;
  keeper_ = std::thread([this] { keep_runs(); });
  parts_.store.listen([this](std::string_view id) {
    poke();
    if (id.empty()) {
      parts_.changes.notify_all();
    } else {
      parts_.changes.notify(id);
    }
  });
}

void JobRunner::keep_runs() {
  while (true) {
    keep_runs_once();
    std::unique_lock lock(mutex_);
    if (stopped_.wait_for(lock, kKeepInterval, [this] { return stopping_ && running_.empty(); })) {
      return;
    }
  }
}

void JobRunner::keep_runs_once() {
  std::vector<RunState> runs;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, running] : running_) {
      runs.push_back({id, running->attempt, running->context.progress()});
    }
  }
  try {
    const std::vector<RunOrder> orders =
        runs.empty() ? std::vector<RunOrder>() : parts_.store.keep(runs);
    const std::size_t rescued = parts_.store.rescue();
    if (rescued > 0) {
      parts_.metrics.count("symcell_jobs_rescued_total", {}, static_cast<double>(rescued));
      parts_.logger.warning("jobs_rescued", {{"count", static_cast<std::int64_t>(rescued)}});
      poke();
    }
    const std::lock_guard lock(mutex_);
    for (const RunOrder& order : orders) {
      const auto running = running_.find(order.id);
      if (running != running_.end()) running->second->context.cancel();
    }
  } catch (const std::exception&) {
    // Told by the store's watch. Whoever else runs these jobs meanwhile is told apart by its attempt.
  }
}

void JobRunner::poke() {
  {
    const std::lock_guard lock(mutex_);
    ++pokes_;
  }
  wanted_.notify_one();
}

bool JobRunner::wait_for_work(std::uint64_t seen) {
  const auto news = [&] { return stopping_ || pokes_ != seen; };
  std::unique_lock lock(mutex_);
  // Word from other servers may be lost with a connection.
  if (parts_.store.shared()) {
    wanted_.wait_for(lock, kPollInterval, news);
  } else {
    wanted_.wait(lock, news);
  }
  return !stopping_;
}

void JobRunner::work() {
  while (true) {
    std::uint64_t seen = 0;
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return;
      seen = pokes_;
      ++claiming_;
    }
    const std::optional<Job> job = claim();
    if (job) {
      run(*job);
      continue;
    }
    {
      const std::lock_guard lock(mutex_);
      if (--claiming_ == 0) cancelled_meanwhile_.clear();
    }
    if (!wait_for_work(seen)) return;
  }
}

std::optional<Job> JobRunner::claim() {
  std::optional<Job> job;
  try {
    static_cast<void>(persist({}, [&] { job = parts_.store.claim(now_ms()); }));
  } catch (const std::exception& exception) {
    // A row that nobody can read, or worse: the others are served when the next job comes.
    parts_.logger.error("job_claim_failed", {{"what", exception.what()}});
    parts_.metrics.count("symcell_internal_errors_total", {{"where", "job"}});
  }
  return job;
}

std::shared_ptr<JobRunner::Running> JobRunner::enter(const Job& job) {
  const std::string& id = job.id;
  auto running = std::make_shared<Running>();
  running->attempt = job.attempt;
  const std::lock_guard lock(mutex_);
  running_.emplace(id, running);
  if (cancelled_meanwhile_.erase(id) > 0) running->context.cancel();
  if (--claiming_ == 0) cancelled_meanwhile_.clear();
  if (stopping_) {
    running->requeue = true;
    running->context.cancel();
  }
  return running;
}

JobRunner::CancelResult JobRunner::cancel(std::string_view id) {
  const std::lock_guard lock(mutex_);
  if (const auto running = running_.find(id); running != running_.end()) {
    running->second->context.cancel();
    return CancelResult::kStopping;
  }
  if (claiming_ > 0) cancelled_meanwhile_.emplace(id);
  return CancelResult::kNotHere;
}

std::optional<Progress> JobRunner::progress(std::string_view id) const {
  const std::lock_guard lock(mutex_);
  const auto running = running_.find(id);
  if (running == running_.end()) return std::nullopt;
  return running->second->context.progress();
}

std::size_t JobRunner::overdue() const {
  const std::lock_guard lock(mutex_);
  const std::int64_t now = steady_ms();
  return static_cast<std::size_t>(std::ranges::count_if(running_, [&](const auto& entry) {
    const double ran_s = static_cast<double>(now - entry.second->started_steady_ms) / 1000;
    return ran_s > entry.second->limit_s + kOverdueSeconds;
  }));
}

std::size_t JobRunner::running() const {
  const std::lock_guard lock(mutex_);
  return running_.size();
}

bool JobRunner::stop(std::chrono::milliseconds grace) {
  std::unique_lock lock(mutex_);
  stopping_ = true;
  stopped_.notify_all();
  wanted_.notify_all();
  const auto none_runs = [this] { return running_.empty(); };
  if (!idle_.wait_for(lock, grace, none_runs)) {
    for (const auto& [id, running] : running_) {
      running->requeue = true;
      running->context.cancel();
    }
    if (!idle_.wait_for(lock, kCancelPatience, none_runs)) return false;
  }
  lock.unlock();
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
  return true;
}

void JobRunner::run(const Job& job) {
  const std::string& id = job.id;
  const auto running = enter(job);
  try {
    execute(job, *running);
  } catch (const std::exception& exception) {
    // A failure that does not pass. The row stays as it is; the next start requeues the job.
    parts_.logger.error("job_bookkeeping_failed", {{"job", id}, {"what", exception.what()}});
    parts_.metrics.count("symcell_internal_errors_total", {{"where", "job"}});
  }
  {
    const std::lock_guard lock(mutex_);
    running_.erase(id);
    // Under the lock: stop() may destroy nothing before the notification is over.
    if (running_.empty()) idle_.notify_all();
  }
  // Whoever deletes a job cancels its run.
  if (running->context.cancelled()) remove_files_if_deleted(id);
  parts_.changes.notify(id);
  // Another of this client's jobs may have waited for this one.
  if (job.most_running > 0) poke();
}

// Whoever deletes a job leaves its files to the worker that still holds it; by now nobody does.
void JobRunner::remove_files_if_deleted(const std::string& id) {
  try {
    if (parts_.store.find(id)) return;
    parts_.faults.remove(id);
    parts_.store.make_durable();
    parts_.files.remove(id);
  } catch (const std::exception& exception) {
    parts_.logger.error("job_bookkeeping_failed", {{"job", id}, {"what", exception.what()}});
  }
}

bool JobRunner::persist(const std::string& id, const std::function<void()>& work) {
  for (std::chrono::milliseconds pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
    std::string fault;
    try {
      work();
      return true;
    } catch (const StoreError& error) {
      fault = error.what();
    } catch (const std::system_error& error) {
      if (!may_pass(error)) throw;
      fault = error.what();
    }
    parts_.metrics.count("symcell_job_write_retries_total");
    parts_.logger.warning("job_write_failed", {{"job", id}, {"what", std::string_view(fault)}});
    std::unique_lock lock(mutex_);
    if (stopped_.wait_for(lock, pause, [this] { return stopping_; })) return false;
  }
}

void JobRunner::count_lost_worker(const std::string& id) {
  {
    // Where everything is told to stop at once, workers may end before the server has them ended.
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
  }
  static_cast<void>(persist(id, [&] { parts_.store.count_lost_worker(id); }) &&
                    persist(id, [&] { parts_.store.make_durable(); }));
}

bool JobRunner::publish(const Job& job, Published& published) {
  return persist(job.id, [&] {
    const auto statistics = parts_.files.statistics(job);
    const auto cell = parts_.files.cell(job);
    name_file(statistics);
    name_file(cell);
    published.statistics = MappedFile(statistics, Links::kRefuse).bytes();
    published.bytes = file_bytes(cell) + static_cast<std::int64_t>(published.statistics.size());
    published.copies.clear();
    if (parts_.store.keeps_copies() &&
        published.bytes <= static_cast<std::int64_t>(kSmallFileBytes)) {
      published.copies = {{statistics.filename(), published.statistics},
                          {cell.filename(), std::string(MappedFile(cell, Links::kRefuse).bytes())}};
      return;
    }
    parts_.files.synchronise_results(job);
  });
}

void JobRunner::execute(const Job& job, Running& running) {
  const std::string& id = job.id;
  const double waited_s =
      static_cast<double>(job.started_ms.value_or(job.created_ms) - job.created_ms) / 1000;
  parts_.metrics.observe("symcell_job_wait_seconds", waited_s);
  parts_.logger.info("job_started", {{"job", id},
                                     {"attempt", std::int64_t{job.attempt}},
                                     {"waited", waited_s},
                                     {"request_id", std::string_view(job.request_id)},
                                     {"trace", trace_id_of(job.traceparent)}});
  parts_.changes.notify(id);

  Result<Published> result;
  try {
    result = run_engine(job, running);
  } catch (const std::bad_alloc&) {
    result = fail(ErrorCode::kMemoryLimit,
                  "not enough memory for this mesh; relax max_area, max_edge or min_angle");
  } catch (const std::exception& exception) {
    parts_.logger.error("job_threw", {{"job", id}, {"what", exception.what()}});
    parts_.metrics.count("symcell_internal_errors_total", {{"where", "job"}});
    result = fail(ErrorCode::kInternal, "internal error; the server's log tells more under " + id);
  }
  settle(job, running, result);
}

Result<JobRunner::Published> JobRunner::run_engine(const Job& job, Running& running) {
  const auto options = options_from_json(nlohmann::json::parse(job.options_json));
  if (!options) return error_of(options);
  EngineJob work;
  work.model = parts_.files.model(job.id);
  work.model_format = job.model_format;
  work.options = *options;
  work.cell = JobFiles::partial(parts_.files.cell(job));
  work.statistics = JobFiles::partial(parts_.files.statistics(job));
  work.lost_workers = job.lost_workers;
  work.on_lost_worker = [this, &job] { count_lost_worker(job.id); };
  try {
    settle_model(parts_.files, job.id);
  } catch (const std::filesystem::filesystem_error&) {
    // There is no model; the check below tells.
  }
  // Left by a run that died.
  if (job.attempt > 1) {
    std::filesystem::remove(work.cell);
    std::filesystem::remove(work.statistics);
  }

  running.limit_s = options->time_limit_s;
  running.context.set_time_limit(options->time_limit_s);
  running.context.set_max_elements(options->max_elements);
  SYMCELL_TRY(running.context.check());
  try {
    check_model(job, parts_.files);
  } catch (const StoredFileDamaged& damaged) {
    return fail(ErrorCode::kInternal,
                std::string(damaged.what()) + "; the server's disk is at fault: submit it again");
  }
  // Again while the disk takes nothing that the engine writes.
  for (std::chrono::milliseconds pause = kFirstMeshPause;;
       pause = std::min(2 * pause, kLongestMeshPause)) {
    const Result<void> meshed = parts_.engine.run(work, running.context);
    if (meshed) break;
    if (meshed.error().code != ErrorCode::kWriteFailed) return error_of(meshed);
    parts_.metrics.count("symcell_job_write_retries_total");
    parts_.logger.warning("job_write_failed",
                          {{"job", job.id}, {"what", std::string_view(meshed.error().message)}});
    // Part of what the disk has no room for.
    std::error_code ignored;
    std::filesystem::remove(work.cell, ignored);
    std::filesystem::remove(work.statistics, ignored);
    {
      std::unique_lock lock(mutex_);
      if (stopped_.wait_for(lock, pause, [this] { return stopping_; })) {
        running.requeue = true;
        return fail(ErrorCode::kCancelled, "the server stops");
      }
    }
    SYMCELL_TRY(running.context.check());
  }
  Published published;
  if (!publish(job, published)) {
    running.requeue = true;
    return fail(ErrorCode::kCancelled, "the server stops");
  }
  return published;
}

void JobRunner::keep_fault(const Job& job, const Error& error) {
  if (!is_fault(error.code)) return;
  parts_.metrics.count("symcell_internal_errors_total", {{"where", "mesh"}});
  const auto kept = parts_.faults.keep(job.id, parts_.files.model(job.id), job.options_json, error);
  parts_.logger.error("job_met_internal_error",
                      {{"job", job.id},
                       {"what", std::string_view(error.message)},
                       {"kept", kept ? kept->native() : std::string("not kept")}});
}

void JobRunner::count_phases(std::string_view statistics) {
  try {
    const auto document = nlohmann::json::parse(statistics, nullptr, false);
    if (!document.is_object()) return;
    if (document.contains("timings_ms")) {
      for (const auto& [phase, ms] : document["timings_ms"].items()) {
        if (!ms.is_number()) continue;
        parts_.metrics.observe("symcell_phase_duration_seconds", ms.get<double>() / 1000,
                               {{"phase", phase}});
      }
    }
    if (document.contains("cell")) {
      parts_.metrics.count("symcell_elements_total", {}, document["cell"].value("elements", 0.0));
    }
  } catch (const nlohmann::json::exception&) {
    // Of an engine that writes other figures.
  }
}

void JobRunner::settle(const Job& job, Running& running, Result<Published>& result) {
  // By a clock that nobody sets.
  const std::int64_t took_ms = steady_ms() - running.started_steady_ms;
  JobChange change{.time_ms = job.started_ms.value_or(0) + took_ms, .attempt = job.attempt};
  JobEvent event = JobEvent::kSucceed;
  if (result) {
    change.result_bytes = result->bytes;
    change.statistics_sha256 = sha256_of(result->statistics);
    change.copies = std::move(result->copies);
  } else if (result.error().code == ErrorCode::kCancelled) {
    event = running.requeue ? JobEvent::kRequeue : JobEvent::kCancel;
  } else {
    event = JobEvent::kFail;
    keep_fault(job, result.error());
    change.error_code = error_code_name(result.error().code);
    change.error_json = problem_document(result.error(), "/v1/jobs/" + job.id, "/model")
                            .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  }
  std::optional<Job> settled;
  const bool written =
      persist(job.id, [&] { settled = parts_.store.apply(job.id, event, change); }) &&
      persist(job.id, [&] { parts_.store.make_durable(); });
  if (!written) {
    // The row says running, and the next start takes the job up again.
    parts_.logger.error("job_end_not_written", {{"job", job.id}});
    return;
  }
  if (!settled) {
    // Deleted while it ran, or started again by another server: run() looks which.
    running.context.cancel();
    return;
  }
  const double seconds = static_cast<double>(took_ms) / 1000;
  const std::string_view state = job_state_name(settled->state);
  parts_.logger.info(event == JobEvent::kRequeue ? "job_requeued" : "job_finished",
                     {{"job", job.id},
                      {"state", state},
                      {"seconds", seconds},
                      {"error", std::string_view(change.error_code)},
                      {"request_id", std::string_view(job.request_id)},
                      {"trace", trace_id_of(job.traceparent)}});
  if (event == JobEvent::kRequeue) return;
  parts_.metrics.observe("symcell_job_duration_seconds", seconds, {{"state", state}});
  if (event == JobEvent::kSucceed) count_phases(result->statistics);
  if (!change.error_code.empty()) {
    parts_.metrics.count("symcell_job_errors_total", {{"code", change.error_code}});
  }
}

}  // namespace symcell::server
