// Vertices of one triangle inside the edge of another.
#pragma once

#include <cstddef>

#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

// A vertex so near to an open edge, as a share of the diameter, lies on it: above the noise of
// single precision, far below features.
inline constexpr double kJunctionRel = 1e-6;

// Open edges are split at the ends of other open edges that lie on them within `tolerance`.
// Returns how many vertices were put in.  Cost: O(n log n) + squares of the open edges, of which
// at most some thousand are looked at.
std::size_t split_at_t_junctions(IndexedSurface& surface, double tolerance);

}  // namespace symcell::solid
