// The engine of the service: every job and inspection runs in a worker process, under limits of
// memory and time. What crashes, loops or takes all memory there is an error of that job.
#pragma once

#include <array>
#include <atomic>
#include <semaphore>
#include <string>

#include "server/base/log.hpp"
#include "server/jobs/job_engine.hpp"
#include "server/worker/worker_pool.hpp"

namespace symcell::server {

struct WorkerSettings {
  PoolSettings pool;
  std::uint64_t memory_bytes = std::uint64_t{4} << 30U;  // of a worker; 0: no limit
  // Of a job; 0: none beyond its time limit. Kept by the kernel, so also where nobody looks.
  std::uint64_t cpu_seconds = 0;
};

class WorkerEngine final : public JobEngine {
 public:
  WorkerEngine(WorkerSettings settings, Logger& logger);

  [[nodiscard]] Result<void> run(const EngineJob& job, ExecutionContext& context) override;
  // Small models are read in this process, by our own parsers; large ones would fill its memory.
  [[nodiscard]] Result<ModelFormat> recognise(const std::filesystem::path& model,
                                              std::optional<ModelFormat> promised,
                                              ExecutionContext& context) override;
  [[nodiscard]] Result<std::string> inspect(const std::filesystem::path& model,
                                            ModelFormat format,
                                            const MeshOptions& options,
                                            ExecutionContext& context) override;
  [[nodiscard]] Result<void> draw(const std::filesystem::path& model,
                                  ModelFormat format,
                                  const MeshOptions& options,
                                  const std::filesystem::path& picture,
                                  ExecutionContext& context) override;
  [[nodiscard]] std::string fault() const override { return pool_.fault(); }
  void declare_metrics(Metrics& metrics) const override;
  void report_metrics(Metrics& metrics) const override;

 private:
  [[nodiscard]] TaskOutcome run_once(const RequestMessage& request, ExecutionContext& context);
  [[nodiscard]] Result<std::string> run_request(const RequestMessage& request,
                                                ExecutionContext& context);
  [[nodiscard]] WorkerLimits limits_of(const MeshOptions& options) const;

  const WorkerSettings settings_;
  Logger& logger_;
  // Several at once would take more memory than time is saved; the rest wait.
  std::counting_semaphore<> large_reads_{2};
  std::array<std::atomic<std::uint64_t>, 5> ends_{};  // indexed by EndKind
  WorkerPool pool_;
};

}  // namespace symcell::server
