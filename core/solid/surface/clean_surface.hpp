// From triangles as read to a closed, oriented surface without self-intersections, or the reason
// why it is none.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell::solid {

struct CleanSurface {
  // Closed (two triangles an edge), oriented (positive volume outside in; cavities inwards),
  // without triangles of no area, if there is no problem.
  IndexedSurface surface;
  std::vector<std::string> repairs;  // what was mended, a sentence each
  std::optional<Error> problem;      // kNotWatertight, kSelfIntersection or kDegenerateGeometry
  std::int32_t shells = 0;
  double volume = 0;
  double area = 0;
  double diameter = 0;  // of the bounding box
  double joined = 0;  // how far points were moved at most to collapse edges far below the tolerance
  Box3 box;
};

// `tolerance_rel`: of the diameter; mending moves the surface by no more, closing of holes and
// wrapping apart.
// Errors: kEmptyFile (no triangles), kIndexOutOfRange, kNonFinite, kCoordinateRange,
// kDegenerateGeometry (all in one point), limits. What can be inspected is a `problem` instead.
[[nodiscard]] Result<CleanSurface> clean_surface(
    const TriangleSurface& input,
    ExecutionContext& context,
    double tolerance_rel = kSurfaceSymmetryToleranceRel,
    Repair repair = Repair::kSafe);

}  // namespace symcell::solid
