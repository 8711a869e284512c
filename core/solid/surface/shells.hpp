// Closed components of a surface, their orientation and nesting.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

struct Shells {
  std::int32_t count = 0;
  std::vector<std::int32_t> of_triangle;
  std::vector<std::int32_t> depth;  // per shell: how many other shells enclose it
  std::size_t flipped_alone = 0;    // triangles turned to agree with their neighbours
  std::size_t flipped_shells = 0;   // shells turned inside out as a whole
};

// Components over common edges; neighbours are made to agree, most triangles of a shell staying as
// they were; shells at even depth get positive, at odd depth (cavities) negative volume.
// Requires: every edge has two triangles.  Errors: kNotWatertight (one-sided: no orientation
// exists), kDegenerateGeometry (a shell that encloses no volume), limits.
// Cost: O(n log n) + shells * triangles for pairs of shells whose boxes are nested.
[[nodiscard]] Result<Shells> orient_shells(IndexedSurface& surface, ExecutionContext& context);

}  // namespace symcell::solid
