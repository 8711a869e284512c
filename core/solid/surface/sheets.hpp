// Edges at which a solid touches itself, taken apart.
#pragma once

#include <cstddef>

#include "core/base/error.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

// Edges with four and more triangles get copies of their ends: faces that have material between
// them, in the order of their angles round the edge, stay together, and each copy moves by `gap`
// into its own material, so that the sheets no longer touch. Returns how many edges were split.
// Requires: outside in front of every triangle.
// Errors: kNotWatertight if material and empty space do not take turns round an edge.
[[nodiscard]] Result<std::size_t> split_sheets(IndexedSurface& surface, double gap);

}  // namespace symcell::solid
