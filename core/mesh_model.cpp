#include "core/mesh_model.hpp"

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/stopwatch.hpp"
#include "core/plane/input/validate_pslg.hpp"
#include "core/plane/mesh_pslg.hpp"
#include "core/plane/symmetry/symmetrise.hpp"
#include "core/solid/mesh_solid.hpp"
#include "core/solid/sector/symmetrise.hpp"

namespace symcell {
namespace {

std::vector<Warning> warnings_of(const plane::SymmetricPslg& symmetric) {
  return symmetric.warnings;
}

std::vector<Warning> warnings_of(const std::unique_ptr<solid::SectorSource>& source) {
  std::vector<Warning> warnings = source->symmetry().warnings;
  if (!source->repairs().empty()) warnings.push_back(surface_repaired_warning(source->repairs()));
  return warnings;
}

void record(const plane::SymmetricPslg& symmetric, Statistics& statistics) {
  Statistics::Symmetry& reported = statistics.symmetry;
  reported.fold = symmetric.fold;
  reported.axis_origin = {symmetric.centre.x, symmetric.centre.y, 0};
  reported.error_rel = symmetric.symmetry_error_rel;
  reported.detected = symmetric.fold_detected;
  statistics.warnings = warnings_of(symmetric);
}

void record(const std::unique_ptr<solid::SectorSource>& source, Statistics& statistics) {
  const solid::Symmetry& found = source->symmetry();
  Statistics::Symmetry& reported = statistics.symmetry;
  reported.fold = found.fold;
  reported.axis_origin = found.frame.origin;
  reported.axis_direction = found.frame.direction();
  reported.error_rel = found.error_rel;
  reported.detected = found.fold_detected;
  statistics.repairs = source->repairs();
  statistics.warnings = warnings_of(source);
}

// `symmetrise` makes the model symmetric, `mesh` meshes what that gives.
template <class Symmetrise, class Mesh>
Result<MeshOutcome> run(const Symmetrise& symmetrise,
                        const Mesh& mesh,
                        bool strict,
                        ExecutionContext& context) {
  Stopwatch total, watch;
  context.report(Phase::kSymmetry, 0.02);
  const auto symmetric = symmetrise();
  if (!symmetric) return error_of(symmetric);
  SYMCELL_TRY(check_strict(strict, warnings_of(*symmetric)));
  const double symmetry_ms = watch.lap();
  Result<MeshOutcome> outcome = mesh(*symmetric);
  if (!outcome) return outcome;
  Statistics& statistics = outcome->statistics;
  record(*symmetric, statistics);
  if (auto exempt = exempt_elements_warning(statistics.exempt, statistics.cell.elements)) {
    statistics.warnings.push_back(std::move(*exempt));
    SYMCELL_TRY(check_strict(strict, statistics.warnings));
  }
  statistics.timings_ms.symmetry = symmetry_ms;
  statistics.timings_ms.total = total.lap();
  return outcome;
}

template <class Found>
Result<Inspection> checked(Result<Found> found, bool strict) {
  if (!found) return error_of(found);
  SYMCELL_TRY(check_strict(strict, found->warnings));
  return Inspection(std::move(*found));
}

}  // namespace

Result<MeshOutcome> mesh_model(const Model& model,
                               const MeshOptions& options,
                               ExecutionContext& context) {
  if (const auto* pslg = std::get_if<Pslg>(&model)) {
    const auto symmetrise = [&]() -> Result<plane::SymmetricPslg> {
      SYMCELL_TRY(plane::validate_pslg(*pslg, context));
      return plane::symmetrise(*pslg, options, context);
    };
    const auto mesh = [&](const plane::SymmetricPslg& symmetric) {
      return plane::mesh_pslg(symmetric, options, context);
    };
    return run(symmetrise, mesh, options.strict, context);
  }
  const auto mesh = [&](const std::unique_ptr<solid::SectorSource>& source) {
    return solid::mesh_solid(*source, options, context);
  };
  if (const auto* plc = std::get_if<Plc>(&model)) {
    return run([&] { return solid::symmetrise_plc(*plc, options, context); }, mesh, options.strict,
               context);
  }
  const auto& surface = std::get<TriangleSurface>(model);
  return run([&] { return solid::symmetrise_surface(surface, options, context); }, mesh,
             options.strict, context);
}

Result<Inspection> inspect_model(const Model& model,
                                 const MeshOptions& options,
                                 ExecutionContext& context) {
  if (const auto* pslg = std::get_if<Pslg>(&model)) {
    SYMCELL_TRY(plane::validate_pslg(*pslg, context));
    return checked(plane::inspect_pslg(*pslg, options, context), options.strict);
  }
  if (const auto* plc = std::get_if<Plc>(&model)) {
    return checked(solid::inspect_plc(*plc, options, context), options.strict);
  }
  return checked(solid::inspect_surface(std::get<TriangleSurface>(model), options, context),
                 options.strict);
}

}  // namespace symcell
