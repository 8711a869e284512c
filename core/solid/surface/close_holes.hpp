// Triangles put into holes of a surface.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

struct HoleLimits {
  double extent = 0;             // holes whose box has no longer diagonal are closed
  std::size_t planar_edges = 0;  // and planar ones of at most so many edges
  double planar_extent = 0;      // and this diagonal
  double flat = 0;               // distance from its plane up to which a hole is planar
  double sheet = 0;              // thinner pieces of surface have no inside: they stay open
};

// No bound on size.
[[nodiscard]] constexpr HoleLimits every_hole(double flat, double sheet) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return {kAny, 0, kAny, flat, sheet};
}

struct ClosedHoles {
  std::size_t count = 0;
  std::size_t triangles = 0;   // put in; their source is that of a neighbour
  double largest = 0;          // diagonal of the largest one's box
  std::vector<Point3> places;  // the middle of each
  std::vector<Point3> sheets;  // a corner of each thin open piece that was left
};

// Loops of edges with one triangle are closed: planar ones by their Delaunay triangulation, others
// by triangles of the least area. Loops that touch each other at vertices are told apart
// arbitrarily; too long ones that are not planar stay open.
// Errors: limits.  Cost: O(n log n), and cubes of the edges of loops that are not planar.
[[nodiscard]] Result<ClosedHoles> close_holes(IndexedSurface& surface,
                                              const HoleLimits& limits,
                                              ExecutionContext& context);

}  // namespace symcell::solid
