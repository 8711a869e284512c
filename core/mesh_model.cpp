#include "core/mesh_model.hpp"

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/stopwatch.hpp"
#include "core/plane/input/validate_pslg.hpp"
#include "core/plane/mesh_pslg.hpp"
#include "core/plane/symmetry/symmetrise.hpp"
#include "core/solid/choose_fold.hpp"
#include "core/solid/mesh_solid.hpp"
#include "core/solid/sector/symmetrise.hpp"

namespace symcell {
namespace {

void record(const plane::SymmetricPslg& symmetric, Statistics& statistics) {
  Statistics::Symmetry& reported = statistics.symmetry;
  reported.fold = symmetric.fold;
  reported.axis_origin = {symmetric.centre.x, symmetric.centre.y, 0};
  reported.error_rel = symmetric.symmetry_error_rel;
  reported.detected = symmetric.fold_detected;
}

struct SymmetricSolid {
  std::unique_ptr<solid::SectorSource> source;
  std::vector<FoldEstimate> candidates;
};

void record(const SymmetricSolid& solid, Statistics& statistics) {
  const solid::Symmetry& found = solid.source->symmetry();
  Statistics::Symmetry& reported = statistics.symmetry;
  reported.fold = found.fold;
  reported.axis_origin = found.frame.origin;
  reported.axis_direction = found.frame.direction();
  reported.error_rel = found.error_rel;
  reported.detected = found.fold_detected;
  reported.candidates = solid.candidates;
  statistics.repairs = solid.source->repairs();
}

Result<SymmetricSolid> at_its_fold(Result<std::unique_ptr<solid::SectorSource>> source,
                                   const MeshOptions& options,
                                   ExecutionContext& context) {
  if (!source) return error_of(source);
  auto chosen = solid::choose_fold(**source, options, context);
  if (!chosen) return error_of(chosen);
  auto& taken = chosen->source ? chosen->source : *source;
  return SymmetricSolid{std::move(taken), std::move(chosen->candidates)};
}

// `symmetrise` makes the model symmetric, `mesh` meshes what that gives.
template <class Symmetrise, class Mesh>
Result<MeshOutcome> run(const Symmetrise& symmetrise, const Mesh& mesh, ExecutionContext& context) {
  Stopwatch total, watch;
  context.report(Phase::kSymmetry, 0.02);
  const auto symmetric = symmetrise();
  if (!symmetric) return error_of(symmetric);
  const double symmetry_ms = watch.lap();
  Result<MeshOutcome> outcome = mesh(*symmetric);
  if (!outcome) return outcome;
  Statistics& statistics = outcome->statistics;
  record(*symmetric, statistics);
  statistics.timings_ms.symmetry = symmetry_ms;
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
  if (const auto* pslg = std::get_if<Pslg>(&model)) {
    const auto symmetrise = [&]() -> Result<plane::SymmetricPslg> {
      SYMCELL_TRY(plane::validate_pslg(*pslg, context));
      return plane::symmetrise(*pslg, options, context);
    };
    const auto mesh = [&](const plane::SymmetricPslg& symmetric) {
      return plane::mesh_pslg(symmetric, options, context);
    };
    return run(symmetrise, mesh, context);
  }
  const auto mesh = [&](const SymmetricSolid& solid) {
    return solid::mesh_solid(*solid.source, options, context);
  };
  if (const auto* plc = std::get_if<Plc>(&model)) {
    const auto symmetrise = [&] { return solid::symmetrise_plc(*plc, options, context); };
    return run([&] { return at_its_fold(symmetrise(), options, context); }, mesh, context);
  }
  const auto& surface = std::get<TriangleSurface>(model);
  const auto symmetrise = [&] { return solid::symmetrise_surface(surface, options, context); };
  return run([&] { return at_its_fold(symmetrise(), options, context); }, mesh, context);
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
