// One random meshing task of a solid, determined by its seed alone: a model and options for it.
#pragma once

#include <cstdint>
#include <ostream>

#include "core/base/error.hpp"
#include "core/model/mesh_options.hpp"
#include "core/plane/mesh_pslg.hpp"
#include "tests/support/random_plc.hpp"

namespace symcell {

struct SolidCase {
  std::uint64_t seed = 0;
  test::RandomPlc model;
  MeshOptions options;
};

// Bounds on shape, size and edges, fold and axis given or not, by chance.
[[nodiscard]] SolidCase make_solid_case(std::uint64_t seed, test::RandomPlc model);

[[nodiscard]] Result<MeshOutcome> mesh(const SolidCase& c);

// How to get the case again, for failure messages.
std::ostream& operator<<(std::ostream& out, const SolidCase& c);

}  // namespace symcell
