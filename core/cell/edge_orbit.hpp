// Edges of a cell by their orbits.
#pragma once

#include <cstdint>

#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/geometry/orbit_vertex.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell {

// An edge by its corners as (orbit, exponent) pairs, turned so that the copies of one edge are
// equal: the mid node of the edge is then the `turn`-th copy of the mid node of `key`.
struct EdgeOrbit {
  std::int32_t orbit_a = 0;
  std::int32_t orbit_b = 0;
  std::int32_t relative = 0;  // exponent of b when a has 0
  friend auto operator<=>(const EdgeOrbit&, const EdgeOrbit&) = default;
};

struct TurnedEdge {
  EdgeOrbit key;
  std::int32_t turn = 0;
};

// `rotations`: of the cell's fold.
[[nodiscard]] TurnedEdge turned_edge(const SymmetryCellMesh& mesh,
                                     const RotationTable& rotations,
                                     OrbitVertex a,
                                     OrbitVertex b);

}  // namespace symcell
