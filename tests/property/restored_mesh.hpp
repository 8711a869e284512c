// The full mesh of a symmetry cell as plain arrays, for checks that want all of it at once.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

// Half-edge 3t + j is opposite corner j of triangle t and runs from corner j + 1 to corner j + 2.
struct RestoredMesh {
  std::vector<Point2> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> regions;  // per triangle
  std::size_t cell_triangles = 0;     // the first ones are the cell itself

  [[nodiscard]] std::int32_t from(std::size_t half_edge) const {
    return triangles[half_edge / 3][(half_edge % 3 + 1) % 3];
  }
  [[nodiscard]] std::int32_t to(std::size_t half_edge) const {
    return triangles[half_edge / 3][(half_edge % 3 + 2) % 3];
  }
  [[nodiscard]] std::int32_t apex(std::size_t half_edge) const {
    return triangles[half_edge / 3][half_edge % 3];
  }
  [[nodiscard]] Point2 at(std::int32_t node) const {
    return points[static_cast<std::size_t>(node)];
  }
};

// Corners only: mid-side nodes of quadratic cells are left out of the triangles.
[[nodiscard]] RestoredMesh restore(const SymmetryCellMesh& cell);

}  // namespace symcell
