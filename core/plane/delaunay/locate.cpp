#include "core/plane/delaunay/locate.hpp"

#include "core/geometry/predicates.hpp"

namespace symcell::plane {
namespace {

// A walk in a Delaunay triangulation ends by itself; round subsegments and with lifted points it
// need not, so it is cut off well above the length of ordinary walks.
constexpr int kMaxSteps = 20'000;

}  // namespace

Location locate(const QuotientTriangulation& mesh, TriangleId start, Point2 x) {
  TriangleId t = start;
  std::int32_t e = 0;
  Point2 local = x;  // x in the frame of t
  std::uint32_t entry = 3;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Triangle& tri = mesh.triangle(t);
    const Point2 p[3] = {mesh.corner_point(tri, 0), mesh.corner_point(tri, 1),
                         mesh.corner_point(tri, 2)};
    std::uint32_t open = 3, blocked = 3;
    // Alternate the order in which edges are tried, so that no cycle repeats for ever.
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t j = (step & 1) != 0 ? i : 2 - i;
      if (j == entry) continue;
      if (orientation(p[next3(j)], p[prev3(j)], local) != Sign::kNegative) continue;
      if (tri.seg[j] != kNoSubsegment || tri.nb[j] == kNoHalfEdge) {
        blocked = j;
      } else {
        open = j;
        break;
      }
    }
    if (open == 3) {
      const bool inside = blocked == 3;
      return {inside ? Location::Kind::kInside : Location::Kind::kBlocked,
              3 * t + (inside ? 0 : blocked), e};
    }
    const HalfEdge g = tri.nb[open];
    if (tri.off[open] != 0) {
      e = mesh.add(e, tri.off[open]);
      local = mesh.rotations().rotate(x, mesh.subtract(0, e));
    }
    t = triangle_of(g);
    entry = local_of(g);
  }
  return {Location::Kind::kLost, 3 * t, e};
}

}  // namespace symcell::plane
