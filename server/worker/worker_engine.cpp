#include "server/worker/worker_engine.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>

#include "api/formats/cad.hpp"
#include "api/formats/dxf_scan.hpp"
#include "api/formats/gzip.hpp"
#include "server/base/metrics.hpp"
#include "server/worker/local_engine.hpp"

namespace symcell::server {
namespace {

// A process killed from outside may have been unlucky: another job took the memory. So often it is
// tried; a crash of its own making is not repeated, the same model would crash again.
constexpr int kMaxTries = 3;
// One that was small when it was killed had no part in what the machine was short of: whatever kills it has
// nothing to do with the job. More runs than these are refused anyhow: something ends all there is.
constexpr int kMaxSmallDeaths = 20;
// Before a run after such an end, times their number: what kills is given time to pass.
constexpr std::chrono::milliseconds kPauseAfterDeath{25};
// To read the largest model takes seconds; this ends what hangs.
constexpr double kMaxReadSeconds = 60;
// Read, a model takes a few times its bytes.
constexpr std::uintmax_t kMaxBytesReadHere = std::uintmax_t{8} << 20U;
constexpr std::size_t kHeadBytes = 16384;  // that show a drawing, comments before it included
// What a job may take beyond its time limit before the kernel ends it, should the server not.
constexpr std::uint64_t kCpuMarginSeconds = 5;

// A cell of quadratic tetrahedra takes some 150 bytes an element. What a child of TetGen's hands back is
// a file too, in memory, and as large as the model that it was given is.
constexpr std::uint64_t kLeastFileBytes = std::uint64_t{4} << 30U;
constexpr std::uint64_t kMostBytesPerElement = 1024;

class LargeRead {
 public:
  explicit LargeRead(std::counting_semaphore<>& places) : places_(places) { places_.acquire(); }
  ~LargeRead() { places_.release(); }
  LargeRead(const LargeRead&) = delete;
  LargeRead& operator=(const LargeRead&) = delete;

 private:
  std::counting_semaphore<>& places_;
};

// 0 is no limit.
std::uint64_t lower_limit(std::uint64_t a, std::uint64_t b) {
  return a == 0 || b == 0 ? std::max(a, b) : std::min(a, b);
}

}  // namespace

WorkerEngine::WorkerEngine(WorkerSettings settings, Logger& logger)
    : settings_(std::move(settings)), logger_(logger), pool_(settings_.pool, logger) {
}

WorkerLimits WorkerEngine::limits_of(const MeshOptions& options) const {
  constexpr double kLongest = 1e9;
  std::uint64_t cpu_seconds = settings_.cpu_seconds;
  if (options.time_limit_s < kLongest) {
    const auto by_time =
        static_cast<std::uint64_t>(std::ceil(options.time_limit_s)) + kCpuMarginSeconds;
    cpu_seconds = lower_limit(cpu_seconds, by_time);
  }
  return {lower_limit(settings_.memory_bytes, options.memory_limit_bytes), cpu_seconds,
          kLeastFileBytes + options.max_elements * kMostBytesPerElement};
}

TaskOutcome WorkerEngine::run_once(const RequestMessage& request, ExecutionContext& context) {
  Result<WorkerPool::Lease> worker = pool_.acquire(context);
  if (!worker) return {error_of(worker)};
  const std::int64_t pid = (*worker)->pid();
  logger_.info("worker_took", {{"pid", pid}, {"model", request.job.model.native()}});
  TaskOutcome outcome = (*worker)->run(request, context);
  pool_.give_back(std::move(*worker));
  if (outcome.end) {
    ++ends_[static_cast<std::size_t>(*outcome.end)];
    logger_.warning("worker_ended", {{"pid", pid},
                                     {"reason", end_kind_name(*outcome.end)},
                                     {"model", request.job.model.native()},
                                     {"stderr", outcome.last_words}});
  }
  return outcome;
}

Result<std::string> WorkerEngine::run_request(const RequestMessage& request,
                                              ExecutionContext& context) {
  int tries = request.job.lost_workers + 1;
  int small_deaths = 0;
  while (true) {
    TaskOutcome outcome = run_once(request, context);
    const bool lost = outcome.end == EndKind::kOutside && !context.cancelled();
    if (!lost) return std::move(outcome.document);
    if (outcome.was_small && small_deaths < kMaxSmallDeaths) {
      std::this_thread::sleep_for(++small_deaths * kPauseAfterDeath);
    } else {
      // Counted where it lasts: three tries are meant in all, not after each start of the server.
      if (request.job.on_lost_worker) request.job.on_lost_worker();
      if (tries >= kMaxTries) return std::move(outcome.document);
      ++tries;
    }
    std::error_code ignored;
    std::filesystem::remove(request.job.cell, ignored);
    std::filesystem::remove(request.job.statistics, ignored);
  }
}

Result<void> WorkerEngine::run(const EngineJob& job, ExecutionContext& context) {
  const auto done = run_request(
      {.task = WorkerTask::kMesh, .job = job, .limits = limits_of(job.options)}, context);
  if (!done) return error_of(done);
  return {};
}

// Drawings are read by a library that trusts its input; what is packed may be one.
bool is_read_by_worker(const std::filesystem::path& model, std::optional<ModelFormat> promised) {
  if (std::filesystem::file_size(model) > kMaxBytesReadHere) return true;
  if (promised == ModelFormat::kDxf || promised == ModelFormat::kStep ||
      promised == ModelFormat::kIges) {
    return true;
  }
  std::string head(kHeadBytes, '\0');
  std::ifstream file(model, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return is_gzip(head) || looks_like_dxf(head) || looks_like_step(head) || looks_like_iges(head);
}

Result<ModelFormat> WorkerEngine::recognise(const std::filesystem::path& model,
                                            std::optional<ModelFormat> promised,
                                            ExecutionContext& context) {
  if (!is_read_by_worker(model, promised)) {
    return LocalEngine().recognise(model, promised, context);
  }
  RequestMessage request;
  request.task = WorkerTask::kRecognise;
  request.job.model = model;
  request.job.model_format = promised.value_or(ModelFormat::kPslgJson);
  request.job.options.time_limit_s = kMaxReadSeconds;
  request.format_is_known = promised.has_value();
  request.limits = limits_of(request.job.options);
  const LargeRead place(large_reads_);
  const auto name = run_request(request, context);
  if (!name) return error_of(name);
  if (const auto format = model_format_of_name(*name)) return *format;
  return fail(ErrorCode::kInternal, "a worker names an unknown format: " + *name);
}

Result<std::string> WorkerEngine::inspect(const std::filesystem::path& model,
                                          ModelFormat format,
                                          const MeshOptions& options,
                                          ExecutionContext& context) {
  RequestMessage request;
  request.task = WorkerTask::kInspect;
  request.limits = limits_of(options);
  request.job.model = model;
  request.job.model_format = format;
  request.job.options = options;
  return run_request(request, context);
}

Result<void> WorkerEngine::draw(const std::filesystem::path& model,
                                ModelFormat format,
                                const MeshOptions& options,
                                const std::filesystem::path& picture,
                                ExecutionContext& context) {
  RequestMessage request;
  request.task = WorkerTask::kDraw;
  request.limits = limits_of(options);
  request.job.model = model;
  request.job.model_format = format;
  request.job.options = options;
  request.job.cell = picture;
  const auto done = run_request(request, context);
  if (!done) return error_of(done);
  return {};
}

void WorkerEngine::declare_metrics(Metrics& metrics) const {
  metrics.declare_gauge("symcell_worker_processes", "Worker processes by state.");
  metrics.declare_counter("symcell_worker_starts_total", "Worker processes started.");
  metrics.declare_counter(
      "symcell_worker_ends_total",
      "Worker processes that ended, by reason: retired after their share of requests, killed by "
      "the server (cancelled, time_limit), memory_limit, crash, or killed from outside.");
}

void WorkerEngine::report_metrics(Metrics& metrics) const {
  const PoolCounts counts = pool_.counts();
  metrics.set("symcell_worker_processes", {{"state", "idle"}}, static_cast<double>(counts.idle));
  metrics.set("symcell_worker_processes", {{"state", "busy"}}, static_cast<double>(counts.busy));
  metrics.count_up_to("symcell_worker_starts_total", {}, static_cast<double>(counts.started));
  metrics.count_up_to("symcell_worker_ends_total", {{"reason", "retired"}},
                      static_cast<double>(counts.retired));
  for (std::size_t kind = 0; kind < ends_.size(); ++kind) {
    metrics.count_up_to("symcell_worker_ends_total",
                        {{"reason", end_kind_name(static_cast<EndKind>(kind))}},
                        static_cast<double>(ends_[kind].load()));
  }
}

}  // namespace symcell::server
