#include "core/solid/cell_search.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/stopwatch.hpp"
#include "core/guard/check_cell.hpp"
#include "core/solid/cut/cut_cell.hpp"
#include "core/solid/sector/mesh_boundary.hpp"

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

bool should_try_another_start(const RefinedSolid& mesh,
                              int starts,
                              std::size_t effort,
                              const MeshOptions& options,
                              const Tuning& tuning) {
  const StartLimits& limits = tuning.starts;
  if (options.plain || starts >= (mesh.guarded > 0 ? limits.meshes_if_bad : limits.meshes))
    return false;
  const auto count = static_cast<double>(mesh.count());
  // Another cut would not mend as many.
  if (tuning.rounds.is_many_bad(mesh.guarded, mesh.count())) return false;
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

}  // namespace

Result<void> check_finished(const SymmetryCellMesh& cell,
                            const BoundaryTopology* boundary,
                            const SectorSource& source,
                            ExecutionContext& context) {
  SYMCELL_TRY(check_cell(cell, boundary));
  return source.check_boundary(cell, context);
}

Result<CellSearch::Found> CellSearch::run() {
  for (int cells = 1;;) {
    if (wants_another_start()) {
      SYMCELL_TRY(mesh_another_start());
      continue;
    }
    if (!best_) return fail(last_);
    SYMCELL_TRY(mesh_again());
    auto cell = cell_of_best();
    if (cell) return Found{std::move(*best_), std::move(*cell)};
    // Rarely, in narrow sectors, a mesh has no cell without flaws: another one has.
    const bool may_go_on =
        cell.error().code == ErrorCode::kInternal && cells < tuning_.starts.cells;
    forget_best();
    if (!may_go_on || !starts_.has_next()) return error_of(cell);
    ++cells;
  }
}

void CellSearch::forget_best() {
  best_.reset();
  starts_.set_has_mesh(false);
  meshed_ = 0;
}

bool CellSearch::wants_another_start() {
  if (meshed_ == 0) return true;
  const StartLimits& limits = tuning_.starts;
  if (out_of_time_ || meshed_ >= limits.meshes_if_bad || !starts_.has_next()) return false;
  if (!best_) return true;
  return should_try_another_start(*best_, meshed_, starts_.effort(), options_, tuning_);
}

// No mesh: another start may have one. An error: no other start is to be tried.
Result<std::optional<RefinedSolid>> CellSearch::mesh_start(Starts& starts,
                                                           const RoundLimits& rounds) {
  const StartLimits& limits = tuning_.starts;
  ++meshed_;
  Stopwatch watch;
  if (!best_) context_.report(Phase::kInitial, 0.08);
  auto solid = starts.next(context_);
  timings_.initial += watch.lap();
  const bool many_bad =
      best_ && rounds.most_growths > 0 && rounds.is_many_bad(best_->guarded, best_->count());
  const std::uint64_t most =
      !best_ ? std::numeric_limits<std::uint64_t>::max()
             : (many_bad ? limits.most_times_larger_if_bad : limits.most_times_larger) *
                   best_->count();
  auto refined = solid ? refine_and_improve(std::move(*solid), options_, most, context_, rounds)
                       : error_of(solid);
  timings_.refine += watch.lap();
  if (refined) {
    starts.set_has_mesh(true);
    return std::optional(std::move(*refined));
  }
  last_ = refined.error();
  // A mesh that turns out invalid is the fault of one cut.
  const bool may_go_on = best_ || last_.code == ErrorCode::kInternal;
  if (!may_go_on || last_.code == ErrorCode::kCancelled) return error_of(refined);
  out_of_time_ = !context_.check();
  return std::optional<RefinedSolid>{};
}

void CellSearch::keep_if_better(RefinedSolid mesh) {
  if (!best_ || is_better(mesh, *best_, options_, tuning_.starts)) best_ = std::move(mesh);
}

Result<void> CellSearch::mesh_another_start() {
  RoundLimits rounds = tuning_.rounds;
  if (source_.may_change_surface() && tuning_.starts.meshes_again > 0) {
    rounds.most_growths = 0;
    rounds.most_followed = tuning_.starts.mendable_again;
  }
  auto mesh = mesh_start(starts_, rounds);
  if (!mesh) return error_of(mesh);
  if (*mesh) keep_if_better(std::move(**mesh));
  return {};
}

// A mesh with a size bound's number of tetrahedra has no fewer from another surface.
bool CellSearch::is_worth_meshing_again() const {
  const StartLimits& limits = tuning_.starts;
  if (options_.plain || out_of_time_) return false;
  if (best_->guarded > 0) return best_->count() <= limits.mendable_again;
  return best_->count() <= limits.cell_again &&
         static_cast<double>(best_->count()) > limits.sized_share * best_->least_count;
}

// The boundary of a mesh is a better surface to mesh than the model's: its triangles are round, and
// as large as the mesh lets them be. It is improved as any other and held against the model. What
// is smaller but has more bad tetrahedra may be the way to one that is both.
Result<void> CellSearch::mesh_again() {
  const StartLimits& limits = tuning_.starts;
  if (!source_.may_change_surface() || !is_worth_meshing_again()) return {};
  StartLimits few = limits;
  few.sectors = limits.sectors_again;
  few.compared = limits.compared_again;
  IndexedSurface boundary = full_boundary(best_->solid.mesh);
  double last_cost = cost(*best_, limits);
  std::uint64_t last_guarded = best_->guarded;
  for (int again = 0; again < limits.meshes_again && is_worth_meshing_again(); ++again) {
    const auto source = source_.with_surface(boundary);
    Starts starts(*source, few);
    starts.set_has_mesh(true);
    auto mesh = mesh_start(starts, tuning_.rounds);
    if (!mesh) return error_of(mesh);
    if (!*mesh) return {};
    const RefinedSolid& made = **mesh;
    const bool goes_on =
        made.guarded < last_guarded || cost(made, limits) < limits.worthwhile_again * last_cost;
    if (goes_on) boundary = full_boundary(made.solid.mesh);
    last_cost = cost(made, limits);
    last_guarded = made.guarded;
    keep_if_better(std::move(**mesh));
    if (!goes_on) return {};
  }
  return {};
}

Result<SymmetryCellMesh> CellSearch::cell_of_best() {
  Stopwatch watch;
  const QuotientTetrahedralization& mesh = best_->solid.mesh;
  context_.report(Phase::kCell, 0.92, mesh.tet_count(), 1);
  const auto cut = cut_cell(mesh, context_);
  timings_.cell += watch.lap();
  if (!cut) return error_of(cut);
  auto cell = build_cell_mesh(best_->solid, *cut, source_.symmetry());
  timings_.cell += watch.lap();
  const auto sound = check_finished(cell, &best_->solid.cover.boundary, source_, context_);
  timings_.check += watch.lap() + best_->check_ms;
  if (!sound) return error_of(sound);
  return cell;
}

}  // namespace symcell::solid
