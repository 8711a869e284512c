// Sizes by the thickness of walls: the presets.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/sizes/size_field.hpp"

namespace symcell::solid {

// Elements across a wall.
[[nodiscard]] constexpr double elements_across(Preset preset) {
  switch (preset) {
    case Preset::kCoarse: return 1;
    case Preset::kNormal: return 2;
    case Preset::kFine: return 4;
    case Preset::kNone: break;
  }
  return 0;
}

// On every triangle the distance to the wall that it looks back at through the
// material, divided by `across`; walls thinner than all but a thousandth of the surface, and than 1/500
// of the extent, count as that.  `surface`: closed, local frame, all copies; `tree`: of it.  `two_sided`: facets
// have no outer side, and gaps count as walls.  Errors: limits.  Cost: O(T log T) as a rule.
[[nodiscard]] Result<std::vector<SizeSource>> wall_sizes(const IndexedSurface& surface,
                                                         const TriangleTree& tree,
                                                         double across,
                                                         bool two_sided,
                                                         ExecutionContext& context);

}  // namespace symcell::solid
