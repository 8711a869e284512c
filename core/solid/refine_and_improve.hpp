// From an initial tetrahedralization to a quality mesh in the quotient: refinement and improvement
// in turn. Source: [paper] sec. 5.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/statistics.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/initial/initial_tetrahedralization.hpp"
#include "core/solid/tuning.hpp"

namespace symcell::solid {

struct RefinedSolid {
  InitialTetrahedralization solid;
  Statistics::Refinement refinement;
  std::vector<ExemptCount> exempt;
  bool delaunay = true;
  // Tetrahedra over the radius-edge bound that nothing of the input exempts.
  std::uint64_t guarded = 0;
  // Of the dihedral angles of the tetrahedra without and with an exemption.
  double least_sine = 1;
  double least_exempt_sine = 1;
  // Tetrahedra that the volume bounds ask for by themselves.
  double least_count = 0;
  double check_ms = 0;  // of the time, for looking at what was made

  [[nodiscard]] std::uint64_t count() const { return solid.mesh.tet_count(); }
};

// `most_tets`: a mesh that gets larger while it is refined is given up.
// Errors: kElementLimit, kTimeLimit, kCancelled, kBoundUnreachable, kInternal (the mesh is not
// valid).
[[nodiscard]] Result<RefinedSolid> refine_and_improve(InitialTetrahedralization solid,
                                                      const MeshOptions& options,
                                                      std::uint64_t most_tets,
                                                      ExecutionContext& context,
                                                      const RoundLimits& limits);

}  // namespace symcell::solid
