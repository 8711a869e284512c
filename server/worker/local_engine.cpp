#include "server/worker/local_engine.hpp"

#include <chrono>
#include <nlohmann/json.hpp>

#include "api/formats/cell_archive.hpp"
#include "api/schema/statistics_json.hpp"
#include "core/mesh_model.hpp"
#include "server/base/files.hpp"
#include "server/worker/process_limits.hpp"

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
  const auto model = read_model(MappedFile(job.model).bytes(), job.model_format);
  if (!model) return tl::unexpected(model.error());
  const double parse_ms = milliseconds_since(start);

  auto outcome = mesh_model(*model, job.options, context);
  if (!outcome) return tl::unexpected(outcome.error());

  const auto write_start = std::chrono::steady_clock::now();
  context.report(Phase::kWrite, 0.99, outcome->mesh.element_count());
  if (const auto written = write_cell(outcome->mesh, job.cell); !written) return written;

  Statistics& statistics = outcome->statistics;
  statistics.timings_ms.parse = parse_ms;
  statistics.timings_ms.write = milliseconds_since(write_start);
  statistics.peak_memory_bytes = peak_resident_bytes();
  statistics.timings_ms.total = milliseconds_since(start);
  FileWriter file(job.statistics);
  file.write(statistics_to_json(statistics, job.options, kind_of(*model)).dump(2) + "\n");
  file.keep();
  context.report(Phase::kDone, 1, outcome->mesh.element_count(), 1);
  return {};
}

Result<ModelFormat> LocalEngine::recognise(const std::filesystem::path& path,
                                           std::optional<ModelFormat> promised,
                                           ExecutionContext& /*context*/) {
  ModelFormat format{};
  const auto model = read_model(MappedFile(path).bytes(), promised, &format);
  if (!model) return tl::unexpected(model.error());
  return format;
}

Result<std::string> LocalEngine::inspect(const std::filesystem::path& path,
                                         ModelFormat format,
                                         const MeshOptions& options,
                                         ExecutionContext& context) {
  const auto model = read_model(MappedFile(path).bytes(), format);
  if (!model) return tl::unexpected(model.error());
  const auto inspection = inspect_model(*model, options, context);
  if (!inspection) return tl::unexpected(inspection.error());
  return inspection_to_json(*inspection).dump(2) + "\n";
}

}  // namespace symcell::server
