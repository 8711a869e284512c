// Edges and corners at which a solid touches itself, taken apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

struct Touching {
  std::size_t edges = 0;    // with four and more triangles
  std::size_t corners = 0;  // at which triangles meet that do not hang together by edges there
  [[nodiscard]] bool none() const { return edges + corners == 0; }
};

// Where the surface touches itself; a corner at such an edge is not counted once more.
// `places`, if given, gets one point each, edges first.
[[nodiscard]] Touching touching_places(const IndexedSurface& surface,
                                       std::vector<Point3>* places = nullptr);

// Ends of such edges, and such corners, get copies: faces that have material between them, in the order of
// their angles round the edge, stay together, and each copy moves by `gap` into its own material, so that
// the sheets no longer touch. Returns what was split.
// Requires: outside in front of every triangle.
// Errors: kNotWatertight if at an edge material does not begin as often as it ends.
[[nodiscard]] Result<Touching> split_sheets(IndexedSurface& surface, double gap);

// Per triangle the body that it bounds, by one of its triangles: what hangs together over edges where, at
// those with four and more triangles, faces that have material between them stay together. Faces of two
// bodies may lie on each other.
// Requires: what has two triangles at an edge is one body there, whichever way they look.
// Errors: as split_sheets().
[[nodiscard]] Result<std::vector<std::int32_t>> bodies_of(const IndexedSurface& surface);

}  // namespace symcell::solid
