// What meshes: an interface between the queue and the mesher, in terms of files and plain values,
// so that the work can move to another process without the queue's noticing, and so that tests can
// stand in for it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "api/formats/model_reader.hpp"
#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"

namespace symcell::server {

struct EngineJob {
  std::filesystem::path model;
  ModelFormat model_format = ModelFormat::kPslgJson;
  MeshOptions options;
  // Files to be written; they don't exist before, and are of no use unless `run` succeeds.
  std::filesystem::path cell;
  std::filesystem::path statistics;
};

class JobEngine {
 public:
  virtual ~JobEngine() = default;

  // Meshes one model.  Called by several threads at once, one context each.
  // Errors: all codes of reading, model, meshing and limits; kCancelled within a second after
  // context.cancel().
  [[nodiscard]] virtual Result<void> run(const EngineJob& job, ExecutionContext& context) = 0;

  // The inspection document as JSON text.  Errors: those of reading and of the model, and limits.
  [[nodiscard]] virtual Result<std::string> inspect(std::string_view model,
                                                    ModelFormat format,
                                                    const MeshOptions& options,
                                                    ExecutionContext& context) = 0;
};

}  // namespace symcell::server
