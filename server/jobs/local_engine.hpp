// The engine that meshes in the server's own process.
#pragma once

#include "server/jobs/job_engine.hpp"

namespace symcell::server {

class LocalEngine final : public JobEngine {
 public:
  [[nodiscard]] Result<void> run(const EngineJob& job, ExecutionContext& context) override;
  [[nodiscard]] Result<std::string> inspect(std::string_view model,
                                            ModelFormat format,
                                            const MeshOptions& options,
                                            ExecutionContext& context) override;
};

}  // namespace symcell::server
