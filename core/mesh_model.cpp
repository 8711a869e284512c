#include "core/mesh_model.hpp"

#include <memory>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "core/plane/input/validate_pslg.hpp"
#include "core/solid/mesh_solid.hpp"

namespace symcell {
namespace {

void record(const solid::SectorSource& source, Statistics& statistics) {
  const solid::Symmetry& found = source.symmetry();
  Statistics::Symmetry& reported = statistics.symmetry;
  reported.fold = found.fold;
  reported.axis_origin = found.frame.origin;
  reported.axis_direction = found.frame.direction();
  reported.error_rel = found.error_rel;
  reported.detected = found.fold_detected;
  statistics.repairs = source.repairs();
}

// `symmetrise`: the step from the model to a source of exact sectors.
template <class Symmetrise>
Result<MeshOutcome> mesh_with(const Symmetrise& symmetrise,
                              const MeshOptions& options,
                              ExecutionContext& context) {
  Stopwatch total, watch;
  context.report(Phase::kSymmetry, 0.02);
  const Result<std::unique_ptr<solid::SectorSource>> source = symmetrise();
  if (!source) return error_of(source);
  const double symmetry_ms = watch.lap();
  Result<MeshOutcome> outcome = solid::mesh_solid(**source, options, context);
  if (!outcome) return outcome;
  Statistics& statistics = outcome->statistics;
  record(**source, statistics);
  statistics.timings_ms.symmetry += symmetry_ms;
  statistics.timings_ms.total = total.lap();
  return outcome;
}

template <class Found>
Result<Inspection> widened(Result<Found> found) {
  if (!found) return error_of(found);
  return Inspection(std::move(*found));
}

}  // namespace

Result<MeshOutcome> mesh_model(const Model& model,
                               const MeshOptions& options,
                               ExecutionContext& context) {
  if (const auto* pslg = std::get_if<Pslg>(&model))
    return plane::mesh_pslg(*pslg, options, context);
  if (const auto* plc = std::get_if<Plc>(&model)) {
    return mesh_with([&] { return solid::symmetrise_plc(*plc, options, context); }, options,
                     context);
  }
  const auto& surface = std::get<TriangleSurface>(model);
  return mesh_with([&] { return solid::symmetrise_surface(surface, options, context); }, options,
                   context);
}

Result<Inspection> inspect_model(const Model& model,
                                 const MeshOptions& options,
                                 ExecutionContext& context) {
  if (const auto* pslg = std::get_if<Pslg>(&model)) {
    SYMCELL_TRY(plane::validate_pslg(*pslg, context));
    return widened(plane::inspect_pslg(*pslg, options, context));
  }
  if (const auto* plc = std::get_if<Plc>(&model)) {
    return widened(solid::inspect_plc(*plc, options, context));
  }
  return widened(solid::inspect_surface(std::get<TriangleSurface>(model), options, context));
}

}  // namespace symcell
