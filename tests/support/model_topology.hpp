// The topology of a model's boundary, as generators know it and as models show it: laws hold meshes
// against it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/point.hpp"
#include "core/model/triangle_surface.hpp"
#include "core/solid/plc/validate_plc.hpp"

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

// Of triangles that meet in whole edges and corners; vertices on none do not count.
[[nodiscard]] BoundaryTopology boundary_topology(
    std::span<const std::array<std::int64_t, 3>> triangles);
// Of segments: vertices - edges.
[[nodiscard]] BoundaryTopology boundary_topology(
    std::span<const std::array<std::int64_t, 2>> segments);
// Vertices at one place are one.
[[nodiscard]] BoundaryTopology boundary_topology(const TriangleSurface& surface);
// Of what is meshed.
[[nodiscard]] BoundaryTopology boundary_topology(const solid::ValidPlc& valid);

}  // namespace symcell::test
