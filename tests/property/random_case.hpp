// One random meshing task, determined by its seed alone: a symmetric model and options for it.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"
#include "tests/support/pslg_builders.hpp"

namespace symcell {

struct RandomCase {
  std::uint64_t seed = 0;
  Pslg model;
  RandomPslgTraits traits;
  std::string description;      // of models cut from grids
  std::vector<Point2> pinches;  // where these touch themselves in a vertex
  MeshOptions options;
  // Whether a mesh must come out: plain refinement is only sure to end for moderate angles.
  bool must_succeed = true;
};

[[nodiscard]] RandomCase make_random_case(std::uint64_t seed);
// Likewise, the model cut from a grid of cells (random_planar_cells.hpp).
[[nodiscard]] RandomCase make_random_cells_case(std::uint64_t seed);

// How to get the case again, for failure messages.
std::ostream& operator<<(std::ostream& out, const RandomCase& c);

// Cases a property test runs over: `usual` of them, or SYMCELL_PROPERTY_RUNS; the first seed is 0,
// or SYMCELL_PROPERTY_SEED.
struct SeedRange {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};
[[nodiscard]] SeedRange property_seeds(std::uint64_t usual);

}  // namespace symcell
