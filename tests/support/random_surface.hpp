// Random closed surfaces that are symmetric in shape and tessellated without regard to it: tori
// with waves, lobed bodies about an axis inside, gears, twisted columns. Coarse and fine, with long
// triangles, about any axis.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/model/triangle_surface.hpp"
#include "tests/support/model_topology.hpp"

namespace symcell::test {

struct RandomSurface {
  TriangleSurface surface;
  std::string description;
  std::int32_t fold = 1;  // of the shape; the tessellation keeps it to within its chords only
  double volume = 0;      // of the tessellation
  double area = 0;
  bool flat = false;  // of few planes: the tessellation keeps the symmetry exactly
  std::optional<BoundaryTopology> boundary;  // where the generator knows it
};

[[nodiscard]] RandomSurface make_random_surface(std::uint64_t seed);

}  // namespace symcell::test
