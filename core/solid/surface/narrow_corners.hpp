// Opens corners of curved parts that are too narrow for good tetrahedra, by flips, collapses and
// moves, for which the surface may deviate more than elsewhere.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/surface/deviation_guard.hpp"
#include "core/solid/surface/editable_surface.hpp"

namespace symcell::solid {

// In a corner below asin(1 / 2B) every subfacet has a circumradius above B times its shortest side,
// and so has the tetrahedron on it; B is the default bound. Radians.
inline constexpr double kNarrowCorner = 20.71 * std::numbers::pi / 180;

class NarrowCorners {
 public:
  // `off`: how far triangles of planar patches may be off their planes.
  NarrowCorners(EditableSurface& mesh, DeviationGuard& guard, double off, ExecutionContext& context)
      : mesh_(mesh), guard_(guard), off_(off), context_(context) {}

  // Relaxes the guard; in passes, until one does nothing.  Errors: limits.
  [[nodiscard]] Result<void> open();

 private:
  [[nodiscard]] bool planar(std::int32_t t) const { return mesh_.surface().patch[t] >= 0; }
  [[nodiscard]] bool open_corners_of(std::int32_t t);
  [[nodiscard]] std::vector<Point3> places_near(std::int32_t v) const;
  // Whether there are fewer narrow corners then; if so, the guard knows of it.
  [[nodiscard]] bool opens(std::span<const std::int32_t> gone,
                           std::span<const PlannedTriangle> planned);
  [[nodiscard]] bool widens(std::int32_t v, Point3 place);

  EditableSurface& mesh_;
  DeviationGuard& guard_;
  double off_;
  ExecutionContext& context_;
};

}  // namespace symcell::solid
