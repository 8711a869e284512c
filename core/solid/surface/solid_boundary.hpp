// The boundary of what a closed surface winds round, however it crosses, touches or covers itself.
//
// All triangles are cut along each other exactly; each piece learns how often the surface winds
// round the points on its two sides; pieces with winding number 1 and more behind them and 0 and
// less before them bound the solid. Bodies that overlap are united by it, sheets that cancel go.
#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

struct SolidBoundary {
  // Every edge has as many triangles one way as the other; four and more where the solid touches
  // itself. Places are rounded, so that triangles may cross again by the last digits.
  IndexedSurface surface;
  IndexedSurface inverted;     // bounds what the surface winds round the wrong way
  double volume = 0;           // of the solid, before it was rounded
  double overlap_volume = 0;   // of what it winds round twice or more
  double cancelled_area = 0;   // of faces that lay on each other from both sides
  double inverted_volume = 0;  // of what it winds round the wrong way
};

// `pairs`: all that self_intersections() finds.
// Requires: at every edge as many triangles run one way as the other.
// Errors: kSelfIntersection (the pieces do not fit together; the reason in the message), limits.
// Cost: O(n log n + pairs log pairs) in exact arithmetic, and n a component for winding numbers.
// Source: [Zhou-et-al16].
[[nodiscard]] Result<SolidBoundary> solid_boundary(
    const IndexedSurface& surface,
    std::span<const std::pair<std::int32_t, std::int32_t>> pairs,
    ExecutionContext& context);

}  // namespace symcell::solid
