// The triangles of a surface cut exactly along each other.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

// One piece; no two have the same corners, and no two meet elsewhere than in common corners and
// sides.
struct Piece {
  Triangle corners{};             // indices of points of the arrangement
  std::int32_t multiplicity = 0;  // triangles that cover it this way round, less the others; not 0
  std::int32_t source = -1;       // of one of these triangles
  std::int32_t triangle = -1;     // one of these triangles
};

// A piece at an edge from u to v, u < v.
struct PieceAtEdge {
  std::int32_t piece = -1;
  std::int32_t multiplicity = 0;  // as if the piece ran from u to v
};

struct Arrangement {
  std::vector<Point3> points;  // rounded; those of the surface first
  std::vector<Piece> pieces;
  // Pieces round each edge, in the order in which one meets them turning from their backs to their
  // fronts (of a piece that runs from u to v), and where each edge's begin; one more at the end.
  std::vector<PieceAtEdge> rings;
  std::vector<std::size_t> ring_begin;
  double cancelled_area = 0;  // of what is covered as often one way as the other, and no piece
  // Per triangle of the surface: those with equal values lie in one plane and overlap or touch.
  std::vector<std::int32_t> plane;
};

// `pairs`: all that self_intersections() finds. Triangles whose corners lie in line are left out.
// Errors: kSelfIntersection (the library failed), limits.
[[nodiscard]] Result<Arrangement> arrange(
    const IndexedSurface& surface,
    std::span<const std::pair<std::int32_t, std::int32_t>> pairs,
    ExecutionContext& context);

}  // namespace symcell::solid
