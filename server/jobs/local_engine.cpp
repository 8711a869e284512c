#include "server/jobs/local_engine.hpp"

#include <chrono>
#include <nlohmann/json.hpp>

#include "api/formats/cell_archive.hpp"
#include "api/schema/statistics_json.hpp"
#include "core/mesh_pslg.hpp"
#include "core/model/validate_pslg.hpp"
#include "core/symmetry/symmetrise.hpp"
#include "server/base/files.hpp"

namespace symcell::server {
namespace {

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

Result<void> write_cell(const SymmetryCellMesh& mesh, const std::filesystem::path& path) {
  FileWriter file(path);
  const auto written = write_cell_archive(mesh, [&](std::string_view piece) {
    file.write(piece);
    return true;
  });
  if (written) file.keep();
  return written;
}

}  // namespace

Result<void> LocalEngine::run(const EngineJob& job, ExecutionContext& context) {
  const auto start = std::chrono::steady_clock::now();
  context.report(Phase::kParse, 0);
  const auto pslg = read_model(MappedFile(job.model).bytes(), job.model_format);
  if (!pslg) return tl::unexpected(pslg.error());
  const double parse_ms = milliseconds_since(start);

  auto outcome = mesh_pslg(*pslg, job.options, context);
  if (!outcome) return tl::unexpected(outcome.error());

  const auto write_start = std::chrono::steady_clock::now();
  context.report(Phase::kWrite, 0.99, outcome->mesh.element_count());
  if (const auto written = write_cell(outcome->mesh, job.cell); !written) return written;

  Statistics& statistics = outcome->statistics;
  statistics.timings_ms.parse = parse_ms;
  statistics.timings_ms.write = milliseconds_since(write_start);
  statistics.timings_ms.total = milliseconds_since(start);
  FileWriter file(job.statistics);
  file.write(statistics_to_json(statistics, job.options).dump(2) + "\n");
  file.keep();
  context.report(Phase::kDone, 1, outcome->mesh.element_count(), 1);
  return {};
}

Result<std::string> LocalEngine::inspect(std::string_view model,
                                         ModelFormat format,
                                         const MeshOptions& options,
                                         ExecutionContext& context) {
  const auto pslg = read_model(model, format);
  if (!pslg) return tl::unexpected(pslg.error());
  if (const auto valid = validate_pslg(*pslg, context); !valid) {
    return tl::unexpected(valid.error());
  }
  const auto inspection = inspect_pslg(*pslg, options, context);
  if (!inspection) return tl::unexpected(inspection.error());
  return inspection_to_json(*inspection).dump(2) + "\n";
}

}  // namespace symcell::server
