#include "tests/unit/server/stub_engine.hpp"

#include <chrono>
#include <fstream>
#include <stdexcept>

#include "api/formats/cell_archive.hpp"
#include "server/base/files.hpp"
#include "server/worker/local_engine.hpp"
#include "tests/support/sample_cells.hpp"

namespace symcell::server::test {

Result<void> StubEngine::run(const EngineJob& job, ExecutionContext& context) {
  ++runs_;
  context.report(Phase::kRefine, 0.5, 42, 0.25);
  {
    std::unique_lock lock(mutex_);
    // A context wakes nobody: look at it now and then, as a mesher does.
    while (!open_ && (ignores_cancel_ || !context.cancelled())) {
      gate_.wait_for(lock, std::chrono::milliseconds(5));
    }
    if (error_) return fail(*error_);
  }
  if (throws_) throw std::runtime_error("the stub throws");
  SYMCELL_TRY(context.check(42));
  FileWriter cell(job.cell);
  const auto written =
      write_cell_archive(symcell::test::ring_cell({}), [&](std::string_view piece) {
        cell.write(piece);
        return true;
      });
  if (!written) return written;
  cell.keep();
  FileWriter statistics(job.statistics);
  statistics.write("{\"cell\": {\"elements\": 12}}\n");
  statistics.keep();
  return {};
}

Result<ModelFormat> StubEngine::recognise(const std::filesystem::path& model,
                                          std::optional<ModelFormat> promised,
                                          ExecutionContext& context) {
  return LocalEngine().recognise(model, promised, context);
}

Result<std::string> StubEngine::inspect(const std::filesystem::path& model,
                                        ModelFormat /*format*/,
                                        const MeshOptions& /*options*/,
                                        ExecutionContext& /*context*/) {
  const std::lock_guard lock(mutex_);
  if (error_) return fail(*error_);
  return "{\"bytes\": " + std::to_string(std::filesystem::file_size(model)) + "}\n";
}

Result<void> StubEngine::draw(const std::filesystem::path& /*model*/,
                              ModelFormat /*format*/,
                              const MeshOptions& /*options*/,
                              const std::filesystem::path& picture,
                              ExecutionContext& /*context*/) {
  const std::lock_guard lock(mutex_);
  if (error_) return fail(*error_);
  std::ofstream(picture) << "glTF";
  return {};
}

void StubEngine::close_gate() {
  const std::lock_guard lock(mutex_);
  open_ = false;
}

void StubEngine::open_gate() {
  {
    const std::lock_guard lock(mutex_);
    open_ = true;
  }
  gate_.notify_all();
}

void StubEngine::fail_with(Error error) {
  const std::lock_guard lock(mutex_);
  error_ = std::move(error);
}

}  // namespace symcell::server::test
