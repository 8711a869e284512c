// The boundary of a wedge's surface as curves in its two half-planes.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/point.hpp"
#include "core/solid/sector/wedge_cut.hpp"

namespace symcell::solid {

// Closed curves repeat no vertex; open ones begin and end on the axis. All run so that lower and
// higher ones correspond: the lower ones as the triangles at them, the higher ones against.
struct CutCurve {
  std::vector<std::int32_t> vertices;  // of the patch
  bool closed = false;
};

struct CutCurves {
  std::vector<CutCurve> lower;
  std::vector<CutCurve> higher;
};

// Errors: kInternal (an open edge off the cuts, a pinch, an edge on the axis).
[[nodiscard]] Result<CutCurves> find_cut_curves(const WedgePatch& patch);

// (distance from the axis, z), closed curves with their first point once more at the end.
[[nodiscard]] std::vector<Point2> curve_points(const WedgePatch& patch, const CutCurve& curve);

}  // namespace symcell::solid
