// The fold of a PSLG's curves, for where arcs are cut.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/point.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"
#include "core/plane/input/arc_chains.hpp"

namespace symcell::plane {

struct CurveSymmetry {
  Point2 centre;
  // 0: any, as there are circles about the centre and nothing else.
  std::int32_t fold = 1;
};

// The largest fold that permutes the ends and middles of arcs, the corners of segments and the
// circles about other points; markers and regions take no part, so that a fold of the model divides
// it. Joints of arcs and of segments in line are left out. A fold and a centre that the user gave
// are taken as they are; else the centre is the centroid of all curves.
// `tolerance`: distance by which copies may differ.  Cost: O(N log N) a divisor tried.
[[nodiscard]] CurveSymmetry find_curve_symmetry(const Pslg& pslg,
                                                const ArcChains& chains,
                                                const MeshOptions& options,
                                                double tolerance);

}  // namespace symcell::plane
