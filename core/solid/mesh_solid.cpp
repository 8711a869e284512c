#include "core/solid/mesh_solid.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "core/cell/measure_cell.hpp"
#include "core/cell/quadratic.hpp"
#include "core/guard/check_cell.hpp"
#include "core/solid/cut/cut_cell.hpp"
#include "core/solid/initial/starts.hpp"
#include "core/solid/refine_and_improve.hpp"

namespace symcell::solid {
namespace {

// Meshes made from different cuts, of which the best is kept: what a cut does to the surface's
// triangles and to the first tetrahedralization shows in meshes that no size bound determines, up
// to twice as many tetrahedra.
constexpr int kMostStarts = 4;
constexpr int kMostStartsIfBad = 8;
// Meshes made for want of one that a symmetry cell can be cut from.
constexpr int kMostCuts = 6;
// Larger cells are meshed once, but for bad tetrahedra, and up to the second of these.
constexpr std::uint64_t kSmallCell = 8'000;
constexpr std::uint64_t kMendableCell = 60'000;
// Before its improvement a mesh of a further start may be larger than the best one by this factor.
constexpr std::uint64_t kMostTimesLarger = 2;
// Triangles that are worked on for the sake of better or fewer tetrahedra.
constexpr std::size_t kMendBudget = 40'000;
constexpr std::size_t kStartBudget = 4'000;
// A size bound determines a mesh of less than so many times the tetrahedra it asks for.
constexpr double kSizedShare = 2.5;
// More bad tetrahedra than this share come of the input, whatever the cut.
constexpr double kHopelessShare = 0.01;
constexpr double kFewBad = 20;  // but so few may come of the cut
// A mesh with a dihedral angle of a sine below this counts as larger by a factor.
constexpr double kPoorSine = 0.26;         // 15 degrees
constexpr double kPoorExemptSine = 0.087;  // 5 degrees: the input may have few more
constexpr double kSizedPoorSine = 0.174;   // 10 degrees: large meshes take their time
constexpr double kPoorFactor = 1.5;

bool is_poor(const RefinedSolid& mesh) {
  return mesh.least_sine < kPoorSine || mesh.least_exempt_sine < kPoorExemptSine;
}

double cost(const RefinedSolid& mesh) {
  return static_cast<double>(mesh.count()) * (is_poor(mesh) ? kPoorFactor : 1);
}

bool is_better(const RefinedSolid& a, const RefinedSolid& b, const MeshOptions& options) {
  if (a.guarded != b.guarded) return a.guarded < b.guarded;
  if (!options.delaunay) return cost(a) < cost(b);
  return a.delaunay != b.delaunay ? a.delaunay : a.count() < b.count();
}

bool is_worth_another_start(const RefinedSolid& mesh,
                            int starts,
                            std::size_t effort,
                            const MeshOptions& options) {
  if (options.plain || starts >= (mesh.guarded > 0 ? kMostStartsIfBad : kMostStarts)) return false;
  const auto count = static_cast<double>(mesh.count());
  if (static_cast<double>(mesh.guarded) > std::max(kFewBad, kHopelessShare * count)) return false;
  const bool sized = count <= kSizedShare * mesh.least_count;
  const bool poor = !options.delaunay && (sized ? mesh.least_sine < kSizedPoorSine : is_poor(mesh));
  if (mesh.guarded > 0 || poor) {
    // Cuts of a surface have other triangles each, cuts of facets as given do not.
    return mesh.count() <= (effort > 0 ? kMendableCell : kSmallCell) && effort <= kMendBudget;
  }
  return !sized && mesh.count() <= kSmallCell && effort <= kStartBudget;
}

Result<RefinedSolid> refine_from_starts(Starts& starts,
                                        const MeshOptions& options,
                                        ExecutionContext& context,
                                        Statistics::TimingsMs& timings) {
  std::optional<RefinedSolid> best;
  Error last;
  for (int start = 0; start < kMostStartsIfBad; ++start) {
    if (start > 0 && !starts.has_next()) break;
    if (best && !is_worth_another_start(*best, start, starts.effort(), options)) break;
    Stopwatch watch;
    if (!best) context.report(Phase::kInitial, 0.08);
    auto solid = starts.next(context);
    timings.initial += watch.lap();
    const std::uint64_t most =
        best ? kMostTimesLarger * best->count() : std::numeric_limits<std::uint64_t>::max();
    auto refined =
        solid ? refine_and_improve(std::move(*solid), options, most, context) : error_of(solid);
    timings.refine += watch.lap();
    if (refined) {
      if (!best || is_better(*refined, *best, options)) best = std::move(*refined);
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
                               ExecutionContext& context) {
  MeshOutcome outcome;
  Statistics& stats = outcome.statistics;
  Starts starts(source);
  for (int attempt = 1;; ++attempt) {
    auto refined = refine_from_starts(starts, options, context, stats.timings_ms);
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
      const auto sound = check_cell(outcome.mesh, &refined->solid.cover.boundary);
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
    const bool may_go_on = last.code == ErrorCode::kInternal && attempt < kMostCuts;
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
