// The engine that meshes in the process that calls it: a worker process, or a test.
#pragma once

#include "server/jobs/job_engine.hpp"

namespace symcell::server {

class LocalEngine final : public JobEngine {
 public:
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
};

}  // namespace symcell::server
