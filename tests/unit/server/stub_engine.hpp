// An engine that meshes nothing: tests decide when it ends and how, and may derive others that do more.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>

#include "server/jobs/job_engine.hpp"

namespace symcell::server::test {

class StubEngine : public JobEngine {
 public:
  // Writes a small ring cell, once open() and unless told to fail.
  [[nodiscard]] Result<void> run(const EngineJob& job, ExecutionContext& context) override;
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

  [[nodiscard]] std::string fault() const override { return broken_ ? "the stub is broken" : ""; }
  void declare_metrics(Metrics& metrics) const override {
    metrics.declare_gauge("stub_engine", "Stands in.");
  }
  void report_metrics(Metrics& metrics) const override { metrics.set("stub_engine", {}, 1); }
  void break_down(bool broken) { broken_ = broken; }

  // From now on jobs wait until opened or cancelled.
  void close_gate();
  void open_gate();
  void fail_with(Error error);
  void throw_from_now_on() { throws_ = true; }
  // Jobs that ignore cancellation until the gate opens.
  void ignore_cancel() { ignores_cancel_ = true; }

  [[nodiscard]] int runs() const { return runs_; }

 private:
  std::mutex mutex_;  // guards open_ and error_
  std::condition_variable gate_;
  bool open_ = true;
  std::optional<Error> error_;
  std::atomic<bool> throws_{false};
  std::atomic<bool> ignores_cancel_{false};
  std::atomic<bool> broken_{false};
  std::atomic<int> runs_{0};
};

}  // namespace symcell::server::test
