// Shells, Euler characteristic and pinches of the surface that n rotated copies of some triangles
// make: the same for a model's surface and for the boundary of its mesh, whatever the triangles.
// Shares no code with the meshers.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/orbit_vertex.hpp"

namespace symcell {

// Corners are copies of vertices, counter-clockwise seen from outside; those on the axis have
// exponent 0.
using OrbitTriangle = std::array<OrbitVertex, 3>;

// An edge of triangles, the same for all of its copies.
struct OrbitEdge {
  std::int32_t low = -1;  // orbits, low <= high
  std::int32_t high = -1;
  std::int32_t exponent = 0;  // of high relative to low; 0 if either is on the axis
  friend auto operator<=>(const OrbitEdge&, const OrbitEdge&) = default;
};

struct OrbitEdgeUse {
  OrbitEdge edge;
  std::int32_t triangle = 0;
  std::int32_t side = 0;  // from corner `side` to the next
  bool forward = false;   // the triangle runs from low to high
};

// `swapped` (may be null): whether b is the lower end.
[[nodiscard]] OrbitEdge orbit_edge(std::int32_t fold,
                                   std::span<const std::uint8_t> on_axis,
                                   OrbitVertex a,
                                   OrbitVertex b,
                                   bool* swapped = nullptr);

// All sides of the triangles, those of one edge together.
[[nodiscard]] std::vector<OrbitEdgeUse> sorted_edge_uses(std::int32_t fold,
                                                         std::span<const std::uint8_t> on_axis,
                                                         std::span<const OrbitTriangle> triangles);

struct BoundaryTopology {
  std::int64_t shells = 0;        // pieces that do not touch, of the whole
  std::int64_t euler = 0;         // vertices - edges + triangles, of the whole
  std::size_t open_edges = 0;     // orbits of edges with more triangles that run one way
  std::size_t pinched_edges = 0;  // orbits of edges with more than two; all copies count
  // Orbits of vertices whose triangles are not one fan and that no pinched edge explains.
  std::vector<std::int32_t> pinched_vertices;  // ascending
  std::vector<std::int32_t> touching;          // those, and the ends of pinched edges; ascending
};

// `on_axis`: per orbit.  Cost: O(n log n).
[[nodiscard]] BoundaryTopology boundary_topology(std::int32_t fold,
                                                 std::span<const std::uint8_t> on_axis,
                                                 std::span<const OrbitTriangle> triangles);

}  // namespace symcell
