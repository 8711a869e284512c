// What all passes over an editable surface ask: how good a triangle is, and which edits leave
// planar patches planar.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/solid/surface/editable_surface.hpp"

namespace symcell::solid {

// Height over longest side; 0.87 is equilateral.
[[nodiscard]] double shape_of(const std::array<Point3, 3>& corners);
// Radians, at x between a and b.
[[nodiscard]] double angle_at(Point3 x, Point3 a, Point3 b);

// Whether a triangle of a planar patch stays in its plane, to within `off`, and faces the same way.
[[nodiscard]] bool keeps_plane(const EditableSurface& mesh, const PlannedTriangle& p, double off);

// The flip of a side inside one patch, or between curved triangles; nothing across creases and
// cuts.
[[nodiscard]] std::optional<FlipPlan> plan_inner_flip(const EditableSurface& mesh,
                                                      std::int32_t t,
                                                      std::int32_t side);

// The triangles that a collapse removes or changes.
[[nodiscard]] std::vector<std::int32_t> gone_of(const CollapsePlan& plan);

}  // namespace symcell::solid
