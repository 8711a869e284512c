// Repairs of a closed surface by CGAL: triangles without area and local self-intersections.
#pragma once

#include <optional>

#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

// Triangles whose corners lie exactly in line are removed by flips and collapses. Nothing if there
// are some that could not be removed; the surface itself if there are none.
// Requires: as below.
[[nodiscard]] std::optional<IndexedSurface> remove_flat_triangles(const IndexedSurface& surface);

// The triangles round self-intersections are taken out and the holes filled: a closed surface
// without self-intersections, or nothing if they could not be mended locally
// (bodies that overlap).  `source` of new triangles is -1.
// Requires: closed, two triangles an edge, consistently oriented.  Cost: some neighbourhoods; meant
// for few intersections.
[[nodiscard]] std::optional<IndexedSurface> mend_intersections(const IndexedSurface& surface);

}  // namespace symcell::solid
