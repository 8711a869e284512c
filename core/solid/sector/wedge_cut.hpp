// The part of a closed surface between two half-planes through the z axis, as a surface with
// boundary on them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

struct WedgePatch {
  std::int32_t fold = 2;
  double start_angle = 0;
  std::vector<Point3> points;
  std::vector<std::uint8_t> on_lower;  // exactly in the half-plane; on the axis both are set
  std::vector<std::uint8_t> on_higher;
  std::vector<Triangle> triangles;
  std::vector<Point3> normals;  // unit normals of the triangles these were cut from

  [[nodiscard]] bool on_axis(std::int32_t v) const { return on_lower[v] != 0 && on_higher[v] != 0; }
};

// Requires: `surface` closed, in the local frame; fold >= 2.  `snap`: vertices nearer than this to
// a half-plane (or the axis) are moved onto it first. Errors: kInternal (a triangle lies in a
// half-plane, or nothing is left: try another angle).
[[nodiscard]] Result<WedgePatch> cut_wedge(const IndexedSurface& surface,
                                           std::int32_t fold,
                                           double start_angle,
                                           double snap);

}  // namespace symcell::solid
