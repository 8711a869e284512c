#include "core/solid/mesh_solid.hpp"

#include <utility>

#include "core/base/stopwatch.hpp"
#include "core/cell/measure_cell.hpp"
#include "core/cell/quadratic.hpp"
#include "core/solid/cell_search.hpp"

namespace symcell::solid {

Result<MeshOutcome> mesh_solid(const SectorSource& source,
                               const MeshOptions& options,
                               ExecutionContext& context,
                               const Tuning& tuning) {
  MeshOutcome outcome;
  Statistics& stats = outcome.statistics;
  auto found = CellSearch(source, options, tuning, context, stats.timings_ms).run();
  if (!found) return error_of(found);
  stats.refinement = found->refined.refinement;
  stats.exempt = std::move(found->refined.exempt);
  stats.delaunay = found->refined.delaunay;
  outcome.mesh = std::move(found->cell);
  Stopwatch watch;
  SYMCELL_TRY(source.label_boundary(outcome.mesh, context));
  if (options.order == 2) outcome.mesh = elevate_to_quadratic(outcome.mesh);
  measure_cell_3(outcome.mesh, stats);
  stats.timings_ms.cell += watch.lap();
  stats.peak_memory_bytes = peak_memory_bytes();
  context.report(Phase::kDone, 1, stats.cell.elements, 1);
  return outcome;
}

}  // namespace symcell::solid
