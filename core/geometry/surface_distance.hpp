// Whether two surfaces are near each other, looked at in samples.
#pragma once

#include <vector>

#include "core/geometry/indexed_surface.hpp"

namespace symcell {

// Vertices, middles of sides and of triangles, each once; neighbours follow each other.
[[nodiscard]] std::vector<Point3> samples_of(const IndexedSurface& surface);

// Whether all samples of each are within `reach` of the other.  Cost: O(n log n).
[[nodiscard]] bool are_near(const IndexedSurface& a, const IndexedSurface& b, double reach);

}  // namespace symcell
