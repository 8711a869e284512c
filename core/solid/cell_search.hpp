// One search over the cuts of a sector for the mesh that the cell is cut from.
//
// What a cut does to the surface's triangles shows in meshes that no size bound determines. Wanted
// are the fewest tetrahedra over a bound, then the fewest of all, where a poor angle counts as more;
// and a symmetry cell without flaws. What the search may cost stands in StartLimits.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/statistics.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/initial/starts.hpp"
#include "core/solid/refine_and_improve.hpp"
#include "core/solid/sector/sector_source.hpp"
#include "core/solid/tuning.hpp"

namespace symcell::solid {

class CellSearch {
 public:
  struct Found {
    RefinedSolid refined;
    SymmetryCellMesh cell;  // checked in itself and against the model
  };

  // What is referred to must outlive the object. `timings`: what initial meshes, refinement, cells
  // and checks take is added.
  CellSearch(const SectorSource& source,
             const MeshOptions& options,
             const Tuning& tuning,
             ExecutionContext& context,
             Statistics::TimingsMs& timings)
      : source_(source),
        options_(options),
        tuning_(tuning),
        context_(context),
        timings_(timings),
        starts_(source, tuning.starts) {}

  // Errors: all meshing and limit codes; kInternal if no mesh has a cell without flaws.
  [[nodiscard]] Result<Found> run();

 private:
  [[nodiscard]] bool wants_another_start();
  [[nodiscard]] Result<std::optional<RefinedSolid>> mesh_start(Starts& starts,
                                                               const RoundLimits& rounds);
  void keep_if_better(RefinedSolid mesh);
  [[nodiscard]] Result<void> mesh_another_start();
  [[nodiscard]] bool is_worth_meshing_again() const;
  [[nodiscard]] Result<void> mesh_again();
  [[nodiscard]] Result<SymmetryCellMesh> cell_of_best();
  void forget_best();

  const SectorSource& source_;
  const MeshOptions& options_;
  const Tuning& tuning_;
  ExecutionContext& context_;
  Statistics::TimingsMs& timings_;
  Starts starts_;
  std::optional<RefinedSolid> best_;
  int meshed_ = 0;  // starts since the last best one was forgotten
  bool out_of_time_ = false;
  Error last_;
};

// Of a finished cell: in itself, and against what it was made from.  `boundary`: as of check_cell.
[[nodiscard]] Result<void> check_finished(const SymmetryCellMesh& cell,
                                          const BoundaryTopology* boundary,
                                          const SectorSource& source,
                                          ExecutionContext& context);

}  // namespace symcell::solid
