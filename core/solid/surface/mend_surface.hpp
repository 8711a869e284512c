// Closed surfaces edited by CGAL: triangles without area and edges that are too short taken out.
#pragma once

#include <optional>

#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

// Triangles whose corners lie exactly in line are removed by flips and collapses. Nothing if there
// are some that could not be removed; the surface itself if there are none.
// Requires: closed, two triangles an edge, consistently oriented; nothing is done elsewhere.
[[nodiscard]] std::optional<IndexedSurface> remove_flat_triangles(const IndexedSurface& surface);

// Edges shorter than `most` are collapsed, the shortest first, to one of their ends, as long as no
// point moves farther than that from where it was, no triangle turns over and the topology stays.
// Short edges between others stay. Nothing if there are none that could be collapsed.
// Requires: as above. The result may intersect itself.  Cost: O(n log n).
[[nodiscard]] std::optional<IndexedSurface> collapse_short_edges(const IndexedSurface& surface,
                                                                 double most);

}  // namespace symcell::solid
