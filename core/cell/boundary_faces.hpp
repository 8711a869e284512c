// The surface of a solid's cell as triangles: what a picture or a surface format shows.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

struct BoundaryFace {
  std::array<std::int32_t, 3> corners{};  // cell nodes, counter-clockwise seen from outside
  bool outer = true;                      // false: on a symmetry bound, inside the full mesh
  std::size_t element = 0;                // of the cell, the one that has the face
  std::size_t opposite = 0;               // its corner that is not on the face
};

// All faces that one element of the cell has, in the order of the elements. Whether a face is
// inside the full mesh follows from the orbits of its corners alone: no list of bounds is needed.
// Requires: dimension 3.  Cost: O(E log E) for E elements, 100 bytes an element.
[[nodiscard]] std::vector<BoundaryFace> boundary_faces(const SymmetryCellMesh& cell);

}  // namespace symcell
