#include "core/solid/mesh_solid.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/stopwatch.hpp"
#include "core/cell/measure_cell.hpp"
#include "core/cell/quadratic.hpp"
#include "core/geometry/rotation.hpp"
#include "core/guard/check_cell.hpp"
#include "core/solid/cut/cut_cell.hpp"
#include "core/solid/initial/starts.hpp"
#include "core/solid/refine_and_improve.hpp"

namespace symcell::solid {
namespace {

bool is_poor(const RefinedSolid& mesh, const StartLimits& limits) {
  return mesh.least_sine < limits.poor_sine || mesh.least_exempt_sine < limits.poor_exempt_sine;
}

double cost(const RefinedSolid& mesh, const StartLimits& limits) {
  return static_cast<double>(mesh.count()) * (is_poor(mesh, limits) ? limits.poor_factor : 1);
}

bool is_better(const RefinedSolid& a,
               const RefinedSolid& b,
               const MeshOptions& options,
               const StartLimits& limits) {
  if (a.guarded != b.guarded) return a.guarded < b.guarded;
  if (!options.delaunay) return cost(a, limits) < cost(b, limits);
  return a.delaunay != b.delaunay ? a.delaunay : a.count() < b.count();
}

// More bad tetrahedra than another cut would mend.
bool has_many_bad(const RefinedSolid& mesh, const StartLimits& limits) {
  return static_cast<double>(mesh.guarded) >
         std::max(limits.few_bad, limits.hopeless_share * static_cast<double>(mesh.count()));
}

bool should_try_another_start(const RefinedSolid& mesh,
                              int starts,
                              std::size_t effort,
                              const MeshOptions& options,
                              const StartLimits& limits) {
  if (options.plain || starts >= (mesh.guarded > 0 ? limits.meshes_if_bad : limits.meshes))
    return false;
  const auto count = static_cast<double>(mesh.count());
  if (has_many_bad(mesh, limits)) return false;
  const bool sized = count <= limits.sized_share * mesh.least_count;
  const bool poor = !options.delaunay &&
                    (sized ? mesh.least_sine < limits.sized_poor_sine : is_poor(mesh, limits));
  if (mesh.guarded > 0 || poor) {
    // Cuts of a surface have other triangles each, cuts of facets as given do not.
    return mesh.count() <= (effort > 0 ? limits.mendable_cell : limits.small_cell) &&
           effort <= limits.mend_budget;
  }
  return !sized && mesh.count() <= limits.small_cell && effort <= limits.start_budget;
}

// Nodes and middles of the boundary's facets, in the local frame.
std::vector<Point3> boundary_points(const SymmetryCellMesh& cell) {
  const RotationTable rotations(cell.fold);
  std::vector<Point3> points;
  std::vector<char> seen(cell.orbit_points.size(), 0);
  for (std::size_t i = 0; i + 2 < cell.boundary.size(); i += 3) {
    Point3 sum;
    for (std::size_t j = i; j < i + 3; ++j) {
      const OrbitVertex v = cell.nodes[static_cast<std::size_t>(cell.boundary[j])];
      const Point3& p = cell.orbit_points[static_cast<std::size_t>(v.orbit)];
      sum = sum + rotations.rotate(p, v.exponent);
      char& known = seen[static_cast<std::size_t>(v.orbit)];
      if (known == 0) points.push_back(p);
      known = 1;
    }
    points.push_back((1.0 / 3) * sum);
  }
  return points;
}

// Of a finished cell: in itself, and against what it was made from.
Result<void> check_finished(const SymmetryCellMesh& cell,
                            const RefinedSolid& refined,
                            const SectorSource& source,
                            ExecutionContext& context) {
  SYMCELL_TRY(check_cell(cell, &refined.solid.cover.boundary));
  return source.check_boundary(boundary_points(cell), context);
}

Result<RefinedSolid> refine_from_starts(Starts& starts,
                                        const MeshOptions& options,
                                        const Tuning& tuning,
                                        ExecutionContext& context,
                                        Statistics::TimingsMs& timings) {
  const StartLimits& limits = tuning.starts;
  std::optional<RefinedSolid> best;
  Error last;
  RoundLimits rounds = tuning.rounds;
  for (int start = 0; start < limits.meshes_if_bad; ++start) {
    if (start > 0 && !starts.has_next()) break;
    // The growth that a mesh is allowed is meant against cascades, and may be what kept it bad.
    const bool may_grow = best && !options.plain && has_many_bad(*best, limits) &&
                          best->count() <= limits.small_cell &&
                          rounds.most_growth == tuning.rounds.most_growth;
    if (may_grow) {
      rounds.most_growth *= limits.more_growth;
    } else if (best && !should_try_another_start(*best, start, starts.effort(), options, limits)) {
      break;
    }
    Stopwatch watch;
    if (!best) context.report(Phase::kInitial, 0.08);
    auto solid = starts.next(context);
    timings.initial += watch.lap();
    const std::uint64_t most =
        best ? (may_grow ? limits.more_growth : limits.most_times_larger) * best->count()
             : std::numeric_limits<std::uint64_t>::max();
    auto refined = solid ? refine_and_improve(std::move(*solid), options, most, context, rounds)
                         : error_of(solid);
    timings.refine += watch.lap();
    if (refined) {
      if (!best || is_better(*refined, *best, options, limits)) best = std::move(*refined);
      continue;
    }
    last = refined.error();
    // A mesh that turns out invalid is the fault of one cut.
    const bool may_go_on = best || last.code == ErrorCode::kInternal;
    if (!may_go_on || last.code == ErrorCode::kCancelled) return refined;
    if (!context.check()) break;
  }
  if (!best) return fail(last);
  return std::move(*best);
}

}  // namespace

Result<MeshOutcome> mesh_solid(const SectorSource& source,
                               const MeshOptions& options,
                               ExecutionContext& context,
                               const Tuning& tuning) {
  MeshOutcome outcome;
  Statistics& stats = outcome.statistics;
  Starts starts(source, tuning.starts);
  for (int attempt = 1;; ++attempt) {
    auto refined = refine_from_starts(starts, options, tuning, context, stats.timings_ms);
    if (!refined) return error_of(refined);
    Stopwatch watch;
    const QuotientTetrahedralization& mesh = refined->solid.mesh;
    context.report(Phase::kCell, 0.92, mesh.tet_count(), 1);
    const auto cut = cut_cell(mesh, context);
    stats.timings_ms.cell += watch.lap();
    Error last;
    if (cut) {
      outcome.mesh = build_cell_mesh(refined->solid, *cut, source.symmetry());
      stats.timings_ms.cell += watch.lap();
      const auto sound = check_finished(outcome.mesh, *refined, source, context);
      stats.timings_ms.check += watch.lap() + refined->check_ms;
      if (sound) {
        stats.refinement = refined->refinement;
        stats.exempt = std::move(refined->exempt);
        stats.delaunay = refined->delaunay;
        break;
      }
      last = sound.error();
    } else {
      last = cut.error();
    }
    // Rarely, in narrow sectors, a mesh has no cell without flaws: another one has.
    const bool may_go_on = last.code == ErrorCode::kInternal && attempt < tuning.starts.cells;
    if (!may_go_on || !starts.has_next()) return fail(last);
  }
  Stopwatch watch;
  if (options.order == 2) outcome.mesh = elevate_to_quadratic(outcome.mesh);
  measure_cell_3(outcome.mesh, stats);
  stats.timings_ms.cell += watch.lap();
  stats.peak_memory_bytes = peak_memory_bytes();
  context.report(Phase::kDone, 1, stats.cell.elements, 1);
  return outcome;
}

}  // namespace symcell::solid
