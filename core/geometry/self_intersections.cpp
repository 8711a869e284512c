#include "core/geometry/self_intersections.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/triangle_tree.hpp"

namespace symcell {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using P = Kernel::Point_3;

// Of two cross products' dot product, relative to the lengths that enter: some 20 roundings of
// 2^-53.
constexpr double kFoldedRounding = 1e-14;

P cgal_point(const Point3& p) {
  return {p.x, p.y, p.z};
}

// Whether a and b lie on different sides of line pq, whatever the rounding: seen along the line, at
// an obtuse angle.
bool surely_apart(const Point3& p, const Point3& q, const Point3& a, const Point3& b) {
  const Point3 u = q - p, v = a - p, w = b - p;
  return dot(cross(u, v), cross(u, w)) <
         -kFoldedRounding * dot(u, u) * std::sqrt(dot(v, v) * dot(w, w));
}

class PairTest {
 public:
  explicit PairTest(const IndexedSurface& surface) : surface_(surface) {}

  [[nodiscard]] bool degenerate(std::int32_t t) const {
    return CGAL::collinear(corner(t, 0), corner(t, 1), corner(t, 2));
  }

  [[nodiscard]] bool intersect(std::int32_t s, std::int32_t t) const {
    const Triangle& a = surface_.triangles[s];
    const Triangle& b = surface_.triangles[t];
    int shared = 0;
    int in_a = 0, in_b = 0;  // sums of the local indices of shared corners
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (a[i] != b[j]) continue;
        ++shared;
        in_a += i;
        in_b += j;
      }
    }
    if (shared == 3) return true;
    if (shared == 2) return folded(s, 3 - in_a, t, 3 - in_b);
    const Kernel::Triangle_3 ta = triangle(s), tb = triangle(t);
    if (shared == 0) return CGAL::do_intersect(ta, tb);
    // One common corner: any other common point shows on a side opposite to the corner.
    return CGAL::do_intersect(tb, opposite_side(s, in_a)) ||
           CGAL::do_intersect(ta, opposite_side(t, in_b));
  }

 private:
  [[nodiscard]] const Point3& point(std::int32_t t, int i) const {
    return surface_.points[surface_.triangles[t][i]];
  }
  [[nodiscard]] P corner(std::int32_t t, int i) const { return cgal_point(point(t, i)); }
  [[nodiscard]] Kernel::Triangle_3 triangle(std::int32_t t) const {
    return {corner(t, 0), corner(t, 1), corner(t, 2)};
  }
  [[nodiscard]] Kernel::Segment_3 opposite_side(std::int32_t t, int i) const {
    return {corner(t, (i + 1) % 3), corner(t, (i + 2) % 3)};
  }
  // A common side: the triangles overlap only if they lie in one plane on one side of it.
  [[nodiscard]] bool folded(std::int32_t s, int apex_s, std::int32_t t, int apex_t) const {
    if (surely_apart(point(s, (apex_s + 1) % 3), point(s, (apex_s + 2) % 3), point(s, apex_s),
                     point(t, apex_t))) {
      return false;
    }
    const P p = corner(s, (apex_s + 1) % 3), q = corner(s, (apex_s + 2) % 3);
    const P a = corner(s, apex_s), b = corner(t, apex_t);
    return CGAL::orientation(p, q, a, b) == CGAL::COPLANAR &&
           CGAL::coplanar_orientation(p, q, a, b) == CGAL::POSITIVE;
  }

  const IndexedSurface& surface_;
};

}  // namespace

Result<std::vector<std::pair<std::int32_t, std::int32_t>>> self_intersections(
    const IndexedSurface& surface, std::size_t limit, ExecutionContext& context) {
  const PairTest test(surface);
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> ids;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto id = static_cast<std::int32_t>(t);
    if (test.degenerate(id)) continue;
    triangles.push_back(surface.triangles[t]);
    ids.push_back(id);
  }
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  std::uint64_t looked_at = 0;
  Result<void> state;
  const TriangleTree tree(surface.points, triangles);
  tree.visit_meeting_boxes([&](std::int32_t a, std::int32_t b) {
    constexpr std::uint64_t kCheckEvery = 4096;  // pairs of boxes
    if (++looked_at % kCheckEvery == 0) {
      state = context.check();
      if (!state) return true;
    }
    const auto [low, high] = std::minmax(ids[a], ids[b]);
    if (test.intersect(low, high)) pairs.emplace_back(low, high);
    return pairs.size() >= limit;
  });
  if (!state) return error_of(state);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace symcell
