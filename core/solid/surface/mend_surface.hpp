// Triangles without area taken out of a closed surface, by CGAL.
#pragma once

#include <optional>

#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

// Triangles whose corners lie exactly in line are removed by flips and collapses. Nothing if there
// are some that could not be removed; the surface itself if there are none.
// Requires: closed, two triangles an edge, consistently oriented; nothing is done elsewhere.
[[nodiscard]] std::optional<IndexedSurface> remove_flat_triangles(const IndexedSurface& surface);

}  // namespace symcell::solid
