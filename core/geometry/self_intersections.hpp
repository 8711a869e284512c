// Pairs of triangles of one surface that meet elsewhere than in their common vertices and edges.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell {

// At most `limit` pairs (smaller index first), in ascending order unless the limit was reached.
// Exact; triangles of no area count as intersecting nothing, remove them first. Two triangles with
// the same three corners intersect.  Errors: limits.  Cost: O(n log n + pairs of boxes that meet).
[[nodiscard]] Result<std::vector<std::pair<std::int32_t, std::int32_t>>> self_intersections(
    const IndexedSurface& surface, std::size_t limit, ExecutionContext& context);

}  // namespace symcell
