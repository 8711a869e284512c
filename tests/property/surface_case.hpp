// One random meshing task of a tessellated surface, and the laws that its mesh keeps.
//
//   verify    every check of verify_mesh against the surface, within the tolerance
//   links     and rim, topology, hanging: link_laws.hpp
//   volume    the surface's, to within what the tolerance moves; exactly where all of it is flat
//   quality   few elements near small features, unless the symmetry's error fills the tolerance
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/model/mesh_options.hpp"
#include "core/plane/mesh_pslg.hpp"
#include "tests/support/random_surface.hpp"

namespace symcell {

struct SurfaceCase {
  std::uint64_t seed = 0;
  test::RandomSurface model;
  MeshOptions options;
};

// Tolerance, fold given or not, and bound on the volume, by chance.
[[nodiscard]] SurfaceCase make_surface_case(std::uint64_t seed, test::RandomSurface model);

// How to get the case again, for failure messages.
std::ostream& operator<<(std::ostream& out, const SurfaceCase& c);

struct MeshedSurface {
  MeshOutcome outcome;
  double error_rel = 0;  // of the symmetry
};
[[nodiscard]] Result<MeshedSurface> mesh(const SurfaceCase& c);

// One line for each law that does not hold.
[[nodiscard]] std::vector<std::string> broken_surface_laws(const SurfaceCase& c,
                                                           const MeshedSurface& meshed);

}  // namespace symcell
