// The full mesh by the textbook way: one constrained Delaunay triangulation of the whole plane
// model, into which whole orbits of vertices are inserted. No quotient, no sector, no bound: what
// the restored mesh must be equal to [paper, theorem 1].
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

// Edge between full node ids (full_mesh.hpp), the smaller one first.
using NodePair = std::pair<std::int32_t, std::int32_t>;

struct OrbitInsertionReference {
  std::vector<NodePair> edges;  // of triangles in the domain, sorted
  std::size_t triangles = 0;    // in the domain
};

// Takes of the cell its orbits of vertices and its subsegments, nothing of its triangles.
// `holes`: seeds of all holes, in model coordinates.  Requires: order 1.
// Cost: O(n N log nN) for N orbits.
[[nodiscard]] OrbitInsertionReference insert_orbits(const SymmetryCellMesh& cell,
                                                    const std::vector<Point2>& holes);

}  // namespace symcell
