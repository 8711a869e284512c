// What meshes: an interface between the queue and the mesher, in terms of files and plain values,
// so that the work can move to another process without the queue's noticing, and so that tests can
// stand in for it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "api/formats/model_reader.hpp"
#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"
#include "server/base/metrics.hpp"

namespace symcell::server {

struct EngineJob {
  std::filesystem::path model;
  ModelFormat model_format = ModelFormat::kPslgJson;
  MeshOptions options;
  // Files to be written; they don't exist before, and are of no use unless `run` succeeds.
  std::filesystem::path cell;
  std::filesystem::path statistics;
  // Processes that were killed from outside while they ran this job before, and who is told of one
  // more; not called for a process that ends by its own fault.
  std::int32_t lost_workers = 0;
  std::function<void()> on_lost_worker = {};
};

class JobEngine {
 public:
  virtual ~JobEngine() = default;

  // Meshes one model.  Called by several threads at once, one context each.
  // Errors: all codes of reading, model, meshing and limits; kCancelled within a second after
  // context.cancel().
  [[nodiscard]] virtual Result<void> run(const EngineJob& job, ExecutionContext& context) = 0;

  // Reads a model and forgets it again: what is malformed is reported before there is a job.
  // `promised`: by name or media type.  Result: what the content turned out to be.  Errors: those
  // of reading, and limits.
  [[nodiscard]] virtual Result<ModelFormat> recognise(const std::filesystem::path& model,
                                                      std::optional<ModelFormat> promised,
                                                      ExecutionContext& context) = 0;

  // The inspection document as JSON text.  Errors: those of reading and of the model, and limits.
  [[nodiscard]] virtual Result<std::string> inspect(const std::filesystem::path& model,
                                                    ModelFormat format,
                                                    const MeshOptions& options,
                                                    ExecutionContext& context) = 0;

  // Draws a model as binary glTF (api/formats/model_glb.hpp) to the file `picture`. The scene's extras hold
  // `inspection`, or `problem` with the code and the message of why there is none.  Errors: those of
  // reading, and limits.
  [[nodiscard]] virtual Result<void> draw(const std::filesystem::path& model,
                                          ModelFormat format,
                                          const MeshOptions& options,
                                          const std::filesystem::path& picture,
                                          ExecutionContext& context) = 0;

  // Why it can run nothing at present; empty if it can.
  [[nodiscard]] virtual std::string fault() const { return {}; }
  // Its own figures, declared once and reported whenever somebody asks for them.
  virtual void declare_metrics(Metrics& metrics) const { static_cast<void>(metrics); }
  virtual void report_metrics(Metrics& metrics) const { static_cast<void>(metrics); }
};

}  // namespace symcell::server
