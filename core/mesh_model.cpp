#include "core/mesh_model.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/stopwatch.hpp"
#include "core/cell/mesh_to_count.hpp"
#include "core/cell/regions_alternate.hpp"
#include "core/plane/arcs/find_chords.hpp"
#include "core/plane/input/discretise_arcs.hpp"
#include "core/plane/input/planar_input.hpp"
#include "core/plane/input/validate_pslg.hpp"
#include "core/plane/mesh_pslg.hpp"
#include "core/plane/symmetry/symmetrise.hpp"
#include "core/solid/choose_fold.hpp"
#include "core/solid/mesh_solid.hpp"
#include "core/solid/sector/symmetrise.hpp"

namespace symcell {
namespace {

std::vector<Warning> warnings_of(const plane::SymmetricPslg& symmetric) {
  return symmetric.warnings;
}

// Divisors that are tried where no sector of the fold found can be meshed, fold 1 among them: each
// takes as long as a job that fails.
constexpr int kMostOtherFolds = 3;

struct SymmetricSolid {
  std::unique_ptr<solid::SectorSource> source;
  std::int32_t largest_fold = 1;
  std::string why_not_largest = "its cell has fewer elements";
  std::vector<FoldEstimate> candidates;
};

std::vector<Warning> warnings_of(const SymmetricSolid& solid) {
  std::vector<Warning> warnings = solid.source->symmetry().warnings;
  const std::vector<std::string>& repairs = solid.source->repairs();
  if (!repairs.empty()) warnings.push_back(surface_repaired_warning(repairs));
  const std::int32_t fold = solid.source->symmetry().fold;
  if (solid.largest_fold > fold) {
    warnings.push_back(fold_not_largest_warning(fold, solid.largest_fold, solid.why_not_largest));
  }
  return warnings;
}

void record(const plane::SymmetricPslg& symmetric, Statistics& statistics) {
  Statistics::Symmetry& reported = statistics.symmetry;
  reported.fold = symmetric.fold;
  reported.axis_origin = {symmetric.centre.x, symmetric.centre.y, 0};
  reported.error_rel = symmetric.symmetry_error_rel;
  reported.detected = symmetric.fold_detected;
}

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
  const std::int32_t largest = (*source)->symmetry().fold;
  auto& taken = chosen->source ? chosen->source : *source;
  SymmetricSolid solid;
  solid.source = std::move(taken);
  solid.largest_fold = largest;
  solid.candidates = std::move(chosen->candidates);
  return solid;
}

// What may be the fault of the sectors, and not of the model or a limit.
bool may_be_the_folds(ErrorCode code) {
  return code == ErrorCode::kTetrahedralizationFailed || code == ErrorCode::kInternal;
}

std::int32_t largest_proper_divisor(std::int32_t n) {
  for (std::int32_t p = 2; p <= n / p; ++p) {
    if (n % p == 0) return n / p;
  }
  return 1;
}

// Where the fold may be chosen and no sector of it can be meshed (one whose copies meet in a single
// point has no cut), one of its divisors is taken, and said.
Result<MeshOutcome> mesh_at_some_fold(SymmetricSolid& solid,
                                      const MeshOptions& options,
                                      ExecutionContext& context) {
  auto outcome = solid::mesh_solid(*solid.source, options, context);
  const bool given = options.fold || options.largest_fold;
  if (outcome || given || !may_be_the_folds(outcome.error().code)) return outcome;
  const std::int32_t found = solid.source->symmetry().fold;
  std::int32_t fold = found;
  for (int tried = 1; fold > 1; ++tried) {
    fold = tried < kMostOtherFolds ? largest_proper_divisor(fold) : 1;
    SYMCELL_TRY(context.check());
    auto other = solid.source->with_fold(fold, context);
    if (!other) continue;
    auto meshed = solid::mesh_solid(**other, options, context);
    if (!meshed && !may_be_the_folds(meshed.error().code)) return meshed;
    if (!meshed) continue;
    solid.source = std::move(*other);
    solid.why_not_largest =
        "at fold " + std::to_string(found) + " there is no mesh: " + outcome.error().message;
    SYMCELL_TRY(check_strict(options.strict, warnings_of(solid)));
    return meshed;
  }
  return outcome;
}

void add_warnings(const PslgNotes& notes, std::vector<Warning>& warnings) {
  std::vector<Warning> found = plane::warnings_of(notes);
  warnings.insert(warnings.begin(), std::make_move_iterator(found.begin()),
                  std::make_move_iterator(found.end()));
}

Result<plane::SymmetricPslg> symmetrise_pslg(const Pslg& pslg,
                                             const MeshOptions& options,
                                             ExecutionContext& context) {
  if (!pslg.has_arcs()) {
    SYMCELL_TRY(plane::validate_pslg(pslg, context));
    return plane::symmetrise(pslg, options, context);
  }
  const auto chorded = plane::discretise_arcs(pslg, options, context);
  if (!chorded) return error_of(chorded);
  auto symmetric = plane::symmetrise(chorded->pslg, options, context);
  if (symmetric) {
    const double tolerance = options.symmetry_tolerance_rel.value_or(kExactSymmetryToleranceRel);
    plane::find_chords(chorded->pslg, tolerance * symmetric->diameter, *symmetric);
  }
  return symmetric;
}

// `symmetrise` makes the model symmetric, `mesh` meshes what that gives.
template <class Symmetrise, class Mesh>
Result<MeshOutcome> run(const Symmetrise& symmetrise,
                        const Mesh& mesh,
                        const MeshOptions& options,
                        ExecutionContext& context) {
  const bool strict = options.strict;
  Stopwatch total, watch;
  context.report(Phase::kSymmetry, 0.02);
  auto symmetric = symmetrise();
  if (!symmetric) return error_of(symmetric);
  SYMCELL_TRY(check_strict(strict, warnings_of(*symmetric)));
  const double symmetry_ms = watch.lap();
  Result<MeshOutcome> outcome =
      options.target_elements == 0
          ? mesh(*symmetric, options)
          : mesh_to_count([&](const MeshOptions& own) { return mesh(*symmetric, own); }, options,
                          context);
  if (!outcome) return outcome;
  Statistics& statistics = outcome->statistics;
  record(*symmetric, statistics);
  std::vector<Warning> found = warnings_of(*symmetric);
  statistics.warnings.insert(statistics.warnings.begin(), std::make_move_iterator(found.begin()),
                             std::make_move_iterator(found.end()));
  if (auto exempt = exempt_elements_warning(statistics.exempt, statistics.cell.elements)) {
    statistics.warnings.push_back(std::move(*exempt));
  }
  SYMCELL_TRY(check_strict(strict, statistics.warnings));
  statistics.timings_ms.symmetry = symmetry_ms;
  statistics.timings_ms.total = total.lap();
  return outcome;
}

// Groups of planar sizes are layers of a drawing.
Result<std::vector<SizeRequest>> sizes_by_marker(const Pslg& pslg, std::vector<SizeRequest> sizes) {
  for (SizeRequest& s : sizes) {
    if (s.kind != SizeRequest::Kind::kGroup) continue;
    const auto name = std::find_if(pslg.marker_names.begin(), pslg.marker_names.end(),
                                   [&](const MarkerName& n) { return n.name == s.group; });
    if (name == pslg.marker_names.end()) {
      return fail(ErrorCode::kBadOption,
                  "sizes: the model names no marker \"" + s.group +
                      "\"; give marker:M=L, or a layer of a drawing",
                  {}, "/options/sizes");
    }
    s.kind = SizeRequest::Kind::kMarker;
    s.id = name->marker;
  }
  return sizes;
}

// What is asked of all sectors together where the model is one of them: its axis and its fold.
MeshOptions of_all_sectors(const MeshOptions& options) {
  if (!options.sector) return options;
  MeshOptions all = options;
  all.axis_origin = options.axis_origin.value_or(Point3{0, 0, 0});
  all.axis_direction = options.axis_direction.value_or(Point3{0, 0, 1});
  if (!options.fold && !options.largest_fold) all.fold = options.sector;
  return all;
}

// `use` of the model as a whole and the options for it.
template <class Use>
auto with_whole_model(const Pslg& given,
                      const MeshOptions& options,
                      ExecutionContext& context,
                      const Use& use) -> decltype(use(given, options)) {
  const auto input = plane::prepare_input(given, options, context);
  if (!input) return error_of(input);
  return *input ? use((*input)->pslg, (*input)->options) : use(given, options);
}

Result<MeshOutcome> mesh_planar(const Pslg& pslg,
                                const MeshOptions& options,
                                ExecutionContext& context) {
  const auto symmetrise = [&] {
    auto symmetric = symmetrise_pslg(pslg, options, context);
    if (symmetric) add_warnings(pslg.notes, symmetric->warnings);
    return symmetric;
  };
  auto sizes = sizes_by_marker(pslg, options.sizes);
  if (!sizes) return error_of(sizes);
  const auto mesh = [&](const plane::SymmetricPslg& symmetric, MeshOptions own) {
    own.sizes = *sizes;
    return plane::mesh_pslg(pslg, symmetric, own, context);
  };
  auto outcome = run(symmetrise, mesh, options, context);
  if (!outcome) return outcome;
  outcome->mesh.marker_names = pslg.marker_names;
  outcome->statistics.symmetry.antiperiodic = regions_alternate(outcome->mesh);
  return outcome;
}

Result<PslgInspection> inspect_planar(const Pslg& pslg,
                                      const MeshOptions& options,
                                      ExecutionContext& context) {
  Result<PslgInspection> found;
  if (pslg.has_arcs()) {
    const auto chorded = plane::discretise_arcs(pslg, options, context);
    if (!chorded) return error_of(chorded);
    found = plane::inspect_pslg(chorded->pslg, options, context);
  } else {
    SYMCELL_TRY(plane::validate_pslg(pslg, context));
    found = plane::inspect_pslg(pslg, options, context);
  }
  if (found) add_warnings(pslg.notes, found->warnings);
  return found;
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
    return with_whole_model(*pslg, options, context,
                            [&](const Pslg& whole, const MeshOptions& own) {
                              return mesh_planar(whole, own, context);
                            });
  }
  const MeshOptions own = of_all_sectors(options);
  const auto mesh = [&](SymmetricSolid& solid, const MeshOptions& sized) {
    return mesh_at_some_fold(solid, sized, context);
  };
  if (const auto* plc = std::get_if<Plc>(&model)) {
    const auto symmetrise = [&] { return solid::symmetrise_plc(*plc, options, context); };
    return run([&] { return at_its_fold(symmetrise(), options, context); }, mesh, options, context);
  }
  const auto& surface = std::get<TriangleSurface>(model);
  const auto symmetrise = [&] { return solid::symmetrise_surface(surface, own, context); };
  return run([&] { return at_its_fold(symmetrise(), own, context); }, mesh, own, context);
}

Result<Inspection> inspect_model(const Model& model,
                                 const MeshOptions& options,
                                 ExecutionContext& context) {
  if (const auto* pslg = std::get_if<Pslg>(&model)) {
    return checked(with_whole_model(*pslg, options, context,
                                    [&](const Pslg& whole, const MeshOptions& own) {
                                      return inspect_planar(whole, own, context);
                                    }),
                   options.strict);
  }
  if (const auto* plc = std::get_if<Plc>(&model)) {
    return checked(solid::inspect_plc(*plc, options, context), options.strict);
  }
  return checked(
      solid::inspect_surface(std::get<TriangleSurface>(model), of_all_sectors(options), context),
      options.strict);
}

}  // namespace symcell
