// Closed components of a surface, their orientation and nesting.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

struct Shells {
  std::int32_t count = 0;
  std::vector<std::int32_t> of_triangle;
  // Per shell: how many others enclose it; of those that meet and look to one side all count once.
  std::vector<std::int32_t> depth;
  std::vector<bool> in_overlap;    // per shell: several that meet enclose it
  std::vector<bool> turned;        // per shell: turned inside out as a whole
  std::size_t flipped_alone = 0;   // triangles turned to agree with their neighbours
  std::size_t flipped_shells = 0;  // shells turned inside out as a whole
};

// Components over edges with two triangles, joined at edges with more where none of them is closed on
// its own; neighbours are made to agree, most triangles of a shell staying as they were; shells at
// even depth get positive, at odd depth (cavities) negative volume.
// `crossing`: pairs of triangles that intersect. A shell that meets another counts as enclosed by it
// only if nothing of it lies outside and it looks to the other side; or if the other is a hollow, and it
// a body of which some lies in the hollow.
// Requires: every edge has an even number of triangles.  Errors: kNotWatertight (one-sided, or no
// orientation at an edge of four), kDegenerateGeometry (a shell that encloses no volume), limits.
// Cost: O(n log n) + shells * triangles for pairs of shells whose boxes are nested.
[[nodiscard]] Result<Shells> orient_shells(
    IndexedSurface& surface,
    ExecutionContext& context,
    std::span<const std::pair<std::int32_t, std::int32_t>> crossing = {});

}  // namespace symcell::solid
