#include "core/mesh_solid.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>

#include "core/cells/quadratic.hpp"
#include "core/cells/solid_cell.hpp"
#include "core/delaunay/solid_legalise.hpp"
#include "core/improve/solid_improver.hpp"
#include "core/initial/initial_tetrahedralization.hpp"
#include "core/refine/solid_refiner.hpp"
#include "core/stats/quality.hpp"
#include "core/tds/validate_tetrahedra.hpp"

namespace symcell {
namespace {

// Sectors that are tried before a model is given up.
constexpr std::int32_t kMaxSectors = 40;
// The improvement works on tetrahedra with a dihedral angle below this or above its supplement.
constexpr double kGoalDeg = 30;
// Rounds of improvement at least, and the depths of refinement after each.
constexpr std::size_t kRounds = 2;
constexpr int kDelaunayRounds = 4;
constexpr int kDepths[] = {2, 2, 3, 4, 5};

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

bool is_limit(ErrorCode code) {
  return code == ErrorCode::kCancelled || code == ErrorCode::kTimeLimit ||
         code == ErrorCode::kMemoryLimit || code == ErrorCode::kElementLimit;
}

// What a wrong seed or a wrong model causes is so for every sector.
bool is_worth_another_sector(ErrorCode code) {
  return code == ErrorCode::kTetrahedralizationFailed || code == ErrorCode::kInternal;
}

Result<InitialTetrahedralization> tetrahedralize_some_sector(const SectorSource& source,
                                                             ExecutionContext& context) {
  const std::int32_t most = std::min(source.candidates(), kMaxSectors);
  Error last;
  for (std::int32_t i = 0; i < most; ++i) {
    auto sector = source.sector(i, context);
    if (!sector) {
      last = sector.error();
      if (is_limit(last.code)) return tl::unexpected<Error>(last);
      continue;
    }
    auto solid = tetrahedralize_sector(*sector, context);
    if (solid) return solid;
    last = solid.error();
    if (!is_worth_another_sector(last.code)) return solid;
  }
  return fail(ErrorCode::kTetrahedralizationFailed,
              "none of " + std::to_string(most) +
                  " sectors of the model could be tetrahedralized; the last one: " + last.message +
                  "; look for nearly touching or needle-like facets, or give another fold");
}

double total_volume(const SolidEditor& editor) {
  double sum = 0;
  for (TetId t = 0; t < editor.mesh().tet_slots(); ++t) {
    if (editor.mesh().alive(t)) sum += editor.measures(t).volume;
  }
  return sum;
}

bool has_bad_tet(const SolidEditor& editor, const SolidCriteria& criteria) {
  const QuotientTetrahedralization& mesh = editor.mesh();
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const bool exempt = criteria.exemption(mesh, mesh.tet(t)) != SolidExemption::kNone;
    if (criteria.is_bad(editor.measures(t), mesh.tet(t).region, exempt)) return true;
  }
  return false;
}

// A bound on the volume asks for at least volume / bound tetrahedra: refuse at once what cannot
// fit.
Result<void> check_volume_budget(const SolidEditor& editor,
                                 const SolidCriteria& criteria,
                                 const ExecutionContext& context) {
  double least = 0;
  for (TetId t = 0; t < editor.mesh().tet_slots(); ++t) {
    if (!editor.mesh().alive(t)) continue;
    least += editor.measures(t).volume / criteria.max_volume(editor.mesh().tet(t).region);
  }
  if (least <= static_cast<double>(context.max_elements())) return {};
  return fail(ErrorCode::kElementLimit,
              "the volume bounds ask for at least " + std::to_string(least) +
                  " tetrahedra in the cell, max_elements is " +
                  std::to_string(context.max_elements()) +
                  "; raise max_volume (or the regions' max_volume) or max_elements");
}

Result<void> refine(SolidEditor& editor,
                    const SolidCriteria& criteria,
                    int depth,
                    ExecutionContext& context,
                    SolidRefineCounters& total) {
  SolidRefiner refiner(editor, criteria, context);
  refiner.set_max_depth(depth);
  auto done = refiner.run();
  total += refiner.counters();
  return done;
}

// Rounds of improvement, each followed by refinement of what it left over the bounds: of more depth
// only where the improvement could not mend it.
Result<void> improve(SolidEditor& editor,
                     const SolidCriteria& criteria,
                     double goal_deg,
                     ExecutionContext& context,
                     SolidRefineCounters& total) {
  const double goal = std::sin(goal_deg * std::numbers::pi / 180);
  for (std::size_t round = 0; round < std::size(kDepths); ++round) {
    context.report(Phase::kImprove, 0.6 + 0.05 * static_cast<double>(round),
                   editor.mesh().tet_count());
    editor.compact();
    SolidSurgery surgery(editor, criteria);
    SolidImprover improver(surgery, criteria, context);
    if (auto ok = improver.round(goal); !ok) return ok;
    if (round + 1 >= kRounds && !has_bad_tet(editor, criteria)) break;
    if (auto ok = refine(editor, criteria, kDepths[round], context, total); !ok) return ok;
  }
  SolidSurgery surgery(editor, criteria);
  return SolidImprover(surgery, criteria, context).mend(goal);
}

// Counts the exempt by reason. A broken size bound must not be handed out.
Result<void> count_exempt(const SolidEditor& editor,
                          const SolidCriteria& criteria,
                          Statistics& statistics) {
  std::uint64_t sharp = 0, axis = 0, guarded = 0;
  const QuotientTetrahedralization& mesh = editor.mesh();
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const TetMeasures& m = editor.measures(t);
    if (criteria.size_excess2(m, mesh.tet(t).region) > 1) {
      const Point3 x = mesh.corner_point(t, 0);
      return fail(ErrorCode::kBoundUnreachable,
                  "a volume or edge bound cannot be reached: a tetrahedron of volume " +
                      std::to_string(m.volume) + " near (" + std::to_string(x.x) + ", " +
                      std::to_string(x.y) + ", " + std::to_string(x.z) +
                      ") of the axis' frame stays too large; raise max_volume or max_edge");
    }
    if (!criteria.is_bad(m, mesh.tet(t).region, false)) continue;
    switch (criteria.exemption(mesh, mesh.tet(t))) {
      case SolidExemption::kSmallInputAngle: ++sharp; break;
      case SolidExemption::kAxis: ++axis; break;
      case SolidExemption::kNone: ++guarded; break;
    }
  }
  if (sharp > 0) statistics.exempt.push_back({"small_input_angle", sharp});
  if (axis > 0) statistics.exempt.push_back({"fold_angle_at_axis", axis});
  if (guarded > 0) statistics.exempt.push_back({"near_small_feature", guarded});
  return {};
}

}  // namespace

Result<MeshOutcome> mesh_solid(const SectorSource& source,
                               const MeshOptions& options,
                               ExecutionContext& context) {
  MeshOutcome outcome;
  Statistics& stats = outcome.statistics;
  auto start = Clock::now();
  context.report(Phase::kInitial, 0.08);
  auto solid = tetrahedralize_some_sector(source, context);
  if (!solid) return tl::unexpected<Error>(solid.error());
  stats.timings_ms.initial = milliseconds_since(start);

  start = Clock::now();
  QuotientTetrahedralization& mesh = solid->mesh;
  SolidEditor editor(mesh);
  const double volume = total_volume(editor);
  const SolidCriteria criteria(*solid, options);
  if (auto ok = check_volume_budget(editor, criteria, context); !ok) {
    return tl::unexpected<Error>(ok.error());
  }
  {
    SolidSurgery surgery(editor, criteria);
    static_cast<void>(SolidImprover(surgery, criteria, context).collapse_cut_vertices());
  }
  SolidRefineCounters refined;
  const bool alone = options.delaunay || options.plain;
  const int depth = alone ? SolidRefiner::kMaxChain : kDepths[0];
  if (auto ok = refine(editor, criteria, depth, context, refined); !ok) {
    return tl::unexpected<Error>(ok.error());
  }
  // What flips make bad is refined again.
  for (int round = 0; options.delaunay && round < kDelaunayRounds; ++round) {
    const auto flips = legalise(editor, context);
    if (!flips) return tl::unexpected<Error>(flips.error());
    if (*flips == 0) break;
    if (auto ok = refine(editor, criteria, depth, context, refined); !ok) {
      return tl::unexpected<Error>(ok.error());
    }
  }
  if (!alone) {
    const double goal_deg = std::max(kGoalDeg, options.min_dihedral_deg);
    if (auto ok = improve(editor, criteria, goal_deg, context, refined); !ok) {
      return tl::unexpected<Error>(ok.error());
    }
  }
  for (std::size_t v = 0; v < mesh.vertex_slots(); ++v) {
    const SolidVertexKind kind = mesh.kind(static_cast<VertexId>(v));
    const bool steiner = kind != SolidVertexKind::kInput && kind != SolidVertexKind::kDeleted;
    stats.refinement.steiner_points += steiner ? 1 : 0;
  }
  stats.refinement.splits = refined.segment_splits;
  stats.refinement.flips = editor.counters().flips;
  stats.refinement.crossings = editor.counters().crossings;
  stats.refinement.relocations = editor.counters().moves;
  stats.refinement.removed = editor.counters().collapses;
  stats.timings_ms.refine = milliseconds_since(start);

  start = Clock::now();
  context.report(Phase::kCell, 0.92, mesh.tet_count(), 1);
  const auto report = validate_tetrahedra(mesh, ValidationLevel::kEmbedding, volume);
  if (!report) return tl::unexpected<Error>(report.error());
  stats.delaunay = count_illegal(editor) == 0;
  if (auto ok = count_exempt(editor, criteria, stats); !ok) {
    return tl::unexpected<Error>(ok.error());
  }
  mesh.compact();
  const auto cut = cut_solid_cell(mesh, context);
  if (!cut) return tl::unexpected<Error>(cut.error());
  outcome.mesh = build_solid_cell_mesh(*solid, *cut, source.symmetry());
  if (options.order == 2) outcome.mesh = elevate_to_quadratic(outcome.mesh);
  measure_cell_3(outcome.mesh, stats);
  stats.timings_ms.cell = milliseconds_since(start);
  stats.peak_memory_bytes = peak_memory_bytes();
  context.report(Phase::kDone, 1, stats.cell.elements, 1);
  return outcome;
}

}  // namespace symcell
