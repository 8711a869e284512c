#include "core/solid/mesh_solid.hpp"

#include <array>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "core/cell/full_mesh.hpp"
#include "core/cell/measure_cell.hpp"
#include "core/cell/quadratic.hpp"
#include "core/geometry/tet_measures.hpp"
#include "core/solid/cell_search.hpp"

namespace symcell::solid {
namespace {

// Tetrahedra that keep the bound on the ratio in one cell and not in the other.
std::uint64_t count_worse(const SymmetryCellMesh& before,
                          const SymmetryCellMesh& after,
                          double ratio) {
  const FullMeshView old_mesh(before), new_mesh(after);
  const auto is_over = [&](const FullMeshView& mesh, std::size_t e) {
    std::array<Point3, 4> p;
    for (std::size_t i = 0; i < 4; ++i) {
      p[i] = mesh.cell_node_position(static_cast<std::size_t>(before.elements[4 * e + i]));
    }
    return measure_tet(p[0], p[1], p[2], p[3]).ratio2() > ratio * ratio;
  };
  std::uint64_t count = 0;
  for (std::size_t e = 0; e < before.element_count(); ++e) {
    count += is_over(new_mesh, e) && !is_over(old_mesh, e) ? 1 : 0;
  }
  return count;
}

// Vertices and mid-side nodes of the boundary onto its faces, and order 2.
Result<void> curve(const SectorSource& source,
                   const BoundaryTopology& boundary,
                   const MeshOptions& options,
                   MeshOutcome& outcome,
                   ExecutionContext& context) {
  const auto faces = source.curved_boundary(outcome.mesh, options);
  if (!faces) {
    if (options.order == 2) outcome.mesh = elevate_to_quadratic(outcome.mesh);
    return {};
  }
  Statistics& stats = outcome.statistics;
  Curving counts;
  faces->count_faces(outcome.mesh, counts);
  // What was asked to be Delaunay stays so.
  if (!options.delaunay) {
    SymmetryCellMesh moved = outcome.mesh;
    Curving of_moves = counts;
    SYMCELL_TRY(faces->move_vertices(moved, of_moves, context));
    if (check_finished(moved, &boundary, source, context)) {
      const std::uint64_t worse = count_worse(outcome.mesh, moved, options.radius_edge);
      if (worse > 0) stats.exempt.push_back({"curved_boundary", worse});
      if (of_moves.vertices > 0) stats.delaunay = false;
      outcome.mesh = std::move(moved);
      counts = of_moves;
    } else {
      // All stay where they were.
      counts.left = of_moves.left + of_moves.vertices;
    }
    SYMCELL_TRY(context.check());
  }
  if (options.order == 2) {
    auto elevated = faces->elevate(outcome.mesh, counts, context);
    if (!elevated) return error_of(elevated);
    outcome.mesh = std::move(*elevated);
  }
  // Of order 1 sides are chords, as they are of faces of no known kind.
  const bool beside = options.order == 2 &&
                      (counts.straightened > 0 || (faces->is_exact() && counts.other_faces > 0));
  if (counts.left > 0 || beside) stats.warnings.push_back(faces_as_chords_warning(counts));
  stats.curving = counts;
  return {};
}

}  // namespace

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
  SYMCELL_TRY(curve(source, found->refined.solid.cover.boundary, options, outcome, context));
  measure_cell_3(outcome.mesh, stats);
  stats.timings_ms.cell += watch.lap();
  stats.peak_memory_bytes = peak_memory_bytes();
  context.report(Phase::kDone, 1, stats.cell.elements, 1);
  return outcome;
}

}  // namespace symcell::solid
