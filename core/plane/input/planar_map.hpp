// The planar subdivision that the segments of a PSLG make: segments cut at the vertices on them,
// and the faces between. One exact plane sweep, no constructions.
//
// Built once, used by validation (crossings, overlaps, seeds), symmetry (which face lies on which
// side of a segment), inspection (area, components, angles) and the last check of a symmetrised
// PSLG.
//
// Half-edge 2p runs from pieces[p].a to pieces[p].b, half-edge 2p + 1 back; its face is the one on
// its left. Face 0 is the unbounded one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/point.hpp"
#include "core/model/pslg.hpp"

namespace symcell::plane {

// A part of a segment between two vertices on it that follow each other.
struct PlanarPiece {
  std::int32_t a = 0;  // lexicographically (x, then y) before b
  std::int32_t b = 0;
  std::int32_t segment = 0;  // source
};

struct PlanarMap {
  std::vector<PlanarPiece> pieces;
  std::vector<std::int32_t> next;         // half-edge: the next one round the face on its left
  std::vector<std::int32_t> face;         // half-edge: face on its left
  std::vector<std::int32_t> vertex_face;  // vertices without a piece: face; others -1
  std::vector<std::int32_t> query_face;   // a query point on a segment: -1
  std::vector<std::int32_t> query_piece;  // the piece a query point lies on, -1
  std::int32_t face_count = 0;
  std::size_t cuts = 0;  // vertices found in the interior of a segment, per segment

  [[nodiscard]] std::int32_t origin(std::int32_t half_edge) const {
    const PlanarPiece& p = pieces[static_cast<std::size_t>(half_edge >> 1)];
    return (half_edge & 1) == 0 ? p.a : p.b;
  }
  [[nodiscard]] std::int32_t target(std::int32_t half_edge) const { return origin(half_edge ^ 1); }
};

// `queries`: points whose faces are asked for.
// Requires: indices in range, no segment of length zero, finite coordinates.
// A repeated segment (same ends, same marker) counts once; a vertex on a segment cuts it.
// Errors: kDuplicateVertices, kSelfIntersection, kOverlappingSegments (with both segments),
// kCancelled, kTimeLimit. Cost: O(N log N).  Source: [ShamosHoey76], made safe for touching and
// vertical segments by the lexicographic order of events; every decision is an exact predicate on
// input points.
[[nodiscard]] Result<PlanarMap> make_planar_map(std::span<const Point2> vertices,
                                                std::span<const PslgSegment> segments,
                                                std::span<const Point2> queries,
                                                ExecutionContext& context);

}  // namespace symcell::plane
