// Arcs that were given by their centres.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/error.hpp"
#include "core/model/pslg.hpp"

namespace symcell {

struct ArcCentre {
  std::int32_t segment = 0;
  Point2 centre;
};

// Gives the segments the bulges of the arcs about their centres, counter-clockwise from a to b. One
// whose ends are the same vertex is a circle: it becomes two halves, the second one a new segment
// with a new vertex, both behind all others.
// Ends that are no vertices are left for the model's validation.
// Errors: kDegenerateGeometry of ends that are not as far from the centre, within 1e-6 of the radius.
[[nodiscard]] Result<void> resolve_arcs(std::span<const ArcCentre> centres, Pslg& pslg);

}  // namespace symcell
