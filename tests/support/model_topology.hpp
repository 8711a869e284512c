// What a generator of models tells of the topology of the boundary: laws hold meshes against it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell::test {

// Edges and corners at which material touches itself with nothing round the place to join it.
struct Pinches {
  std::vector<std::array<Point3, 2>> edges;
  std::vector<Point3> points;
};

// Of the boundary of the material, as a set of points.
struct BoundaryTopology {
  std::int64_t pieces = 0;  // parts that do not touch
  std::int64_t euler = 0;   // vertices - edges + faces
  friend bool operator==(const BoundaryTopology&, const BoundaryTopology&) = default;
};

}  // namespace symcell::test
