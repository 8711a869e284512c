// A turn about a mesh's axis as the affine map that solvers' files ask for.
#pragma once

#include <array>

#include "core/cell/full_mesh.hpp"

namespace symcell {

struct TurnMap {
  std::array<std::array<double, 3>, 3> rotation{};  // rows
  std::array<double, 3> offset{};                   // image = rotation * point + offset
};

// By `exponent` times 360/n degrees, in [0, n).
[[nodiscard]] TurnMap turn_map(const FullMeshView& view, std::int32_t exponent);

}  // namespace symcell
