// Point location by walking the quotient: a walk that leaves the sector carries the exponent.
#pragma once

#include "core/plane/quotient/quotient_triangulation.hpp"

namespace symcell::plane {

struct Location {
  enum class Kind : std::uint8_t {
    kInside,   // `half_edge`: any half-edge of the triangle that holds the point (edges included)
    kBlocked,  // `half_edge`: the subsegment beyond which the point lies
    kLost      // step limit reached
  };
  Kind kind = Kind::kLost;
  HalfEdge half_edge = kNoHalfEdge;
  // Exponent of the found triangle relative to the frame of the starting one.
  std::int32_t exponent = 0;
};

// `x`: a point in the frame of triangle `start`.  Walks round subsegments where it can.
// Cost: O(sqrt(triangles)) expected, bounded by a step limit.
[[nodiscard]] Location locate(const QuotientTriangulation& mesh, TriangleId start, Point2 x);

}  // namespace symcell::plane
