// Vertices of a symmetric model or mesh, named by orbit and copy.
#pragma once

#include <cstdint>

namespace symcell {

// Of an orbit of vertices, or of its representative.
using VertexId = std::int32_t;

// A copy of a vertex: rotation^exponent of the representative of its orbit. Fixed points of the
// rotation (the centre, vertices on the axis) have exponent 0.
struct OrbitVertex {
  VertexId orbit = -1;
  std::int32_t exponent = 0;
  friend bool operator==(const OrbitVertex&, const OrbitVertex&) = default;
};

}  // namespace symcell
