#include "server/worker/local_engine.hpp"

#include <nlohmann/json.hpp>

#include "api/formats/cell_archive.hpp"
#include "api/formats/model_glb.hpp"
#include "api/schema/gates.hpp"
#include "api/schema/statistics_json.hpp"
#include "core/base/stopwatch.hpp"
#include "core/mesh_model.hpp"
#include "server/base/files.hpp"
#include "server/worker/process_limits.hpp"

namespace symcell::server {
namespace {

Result<void> write_cell(const SymmetryCellMesh& mesh, const std::filesystem::path& path) {
  FileWriter file(path);
  auto written = write_cell_archive(mesh, [&](std::string_view piece) {
    file.write(piece);
    return true;
  });
  if (written) file.keep();
  return written;
}

// Whether an error's elements are facets, triangles or segments of the model.
bool names_faces(ErrorCode code) {
  switch (code) {
    case ErrorCode::kSelfIntersection:
    case ErrorCode::kOverlappingSegments:
    case ErrorCode::kZeroLengthSegment:
    case ErrorCode::kDegenerateFacet:
    case ErrorCode::kNonplanarFacet:
    case ErrorCode::kNotWatertight: return true;
    default: return false;
  }
}

}  // namespace

Result<void> LocalEngine::run(const EngineJob& job, ExecutionContext& context) {
  Stopwatch total, watch;
  context.report(Phase::kParse, 0);
  const auto model = read_model(MappedFile(job.model, Links::kRefuse).bytes(), job.model_format,
                                nullptr, reading_for(job.options));
  if (!model) return error_of(model);
  const double parse_ms = watch.lap();

  auto outcome = mesh_model(*model, job.options, context);
  if (!outcome) return error_of(outcome);

  if (!job.options.fail_on.empty()) {
    SYMCELL_TRY(
        check_gates(judge(job.options.fail_on,
                          statistics_to_json(outcome->statistics, job.options, kind_of(*model)))));
  }
  watch.lap();
  context.report(Phase::kWrite, 0.99, outcome->mesh.element_count());
  SYMCELL_TRY(write_cell(outcome->mesh, job.cell));

  Statistics& statistics = outcome->statistics;
  statistics.timings_ms.parse = parse_ms;
  statistics.timings_ms.write = watch.lap();
  statistics.peak_memory_bytes = peak_resident_bytes();
  statistics.timings_ms.total = total.lap();
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
  const auto model = read_model(MappedFile(path, Links::kRefuse).bytes(), promised, &format);
  if (!model) return error_of(model);
  return format;
}

Result<std::string> LocalEngine::inspect(const std::filesystem::path& path,
                                         ModelFormat format,
                                         const MeshOptions& options,
                                         ExecutionContext& context) {
  const auto model =
      read_model(MappedFile(path, Links::kRefuse).bytes(), format, nullptr, reading_for(options));
  if (!model) return error_of(model);
  const auto inspection = inspect_model(*model, options, context);
  if (!inspection) return error_of(inspection);
  return inspection_to_json(*inspection).dump(2) + "\n";
}

Result<void> LocalEngine::draw(const std::filesystem::path& path,
                               ModelFormat format,
                               const MeshOptions& options,
                               const std::filesystem::path& picture,
                               ExecutionContext& context) {
  const auto model =
      read_model(MappedFile(path, Links::kRefuse).bytes(), format, nullptr, reading_for(options));
  if (!model) return error_of(model);
  nlohmann::ordered_json extras;
  std::vector<std::int64_t> at_fault;
  if (const auto inspection = inspect_model(*model, options, context)) {
    extras["inspection"] = inspection_to_json(*inspection);
    if (const auto* solid = std::get_if<SolidInspection>(&*inspection)) at_fault = solid->at_fault;
  } else {
    const Error& error = inspection.error();
    extras["problem"] = {{"code", error_code_name(error.code)}, {"detail", error.message}};
    if (names_faces(error.code)) at_fault.assign(error.elements.begin(), error.elements.end());
  }
  FileWriter file(picture);
  auto drawn = write_model_glb(*model, at_fault, std::move(extras), [&](std::string_view piece) {
    file.write(piece);
    return true;
  });
  if (drawn) file.keep();
  return drawn;
}

}  // namespace symcell::server
