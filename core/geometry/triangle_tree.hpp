// A tree of boxes over triangles: the nearest point of a surface, within a reach; the first triangle on a
// ray; triangles that may meet.
//
// Built by splitting at the median centroid along the longest side. An own tree and not CGAL's:
// the queries here are bounded ("is the surface within 1e-3 of here?"), which lets most of them end
// after one leaf.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

// The point of triangle abc nearest to p.
[[nodiscard]] Point3 closest_point(Point3 p, Point3 a, Point3 b, Point3 c);

class TriangleTree {
 public:
  struct Hit {
    std::int32_t triangle = -1;  // -1: none within reach
    double squared = std::numeric_limits<double>::infinity();
    Point3 point;
  };

  TriangleTree() = default;
  TriangleTree(std::span<const Point3> points, std::span<const Triangle> triangles);

  // The nearest triangle no farther than `reach`.  Cost: O(log n) as a rule.
  [[nodiscard]] Hit nearest(Point3 p, double reach) const {
    std::int32_t last = -1;
    return nearest(p, reach, last);
  }
  // The same for a point near one that was looked for before: the search begins at the place that
  // `last` (-1 at first) names and goes outwards; what it finds does not depend on it.
  [[nodiscard]] Hit nearest(Point3 p, double reach, std::int32_t& last) const;
  // Any triangle no farther than `reach`.
  [[nodiscard]] bool within(Point3 p, double reach) const {
    std::int32_t last = -1;
    return within(p, reach, last);
  }
  // The same, beginning at `last` as above, which afterwards names the triangle that was found and no other.
  [[nodiscard]] bool within(Point3 p, double reach, std::int32_t& last) const;

  // The corners of the triangle that `last` names.
  [[nodiscard]] std::array<Point3, 3> corners_at(std::int32_t last) const {
    const Item& item = items_[static_cast<std::size_t>(last)];
    return {item.a, item.b, item.c};
  }

  struct Meeting {
    std::int32_t triangle = -1;  // -1: none
    double distance = std::numeric_limits<double>::infinity();
  };
  // The first triangle that the ray meets behind its beginning, from either side.  `direction`: of length 1.
  // Cost: O(log n) as a rule.
  [[nodiscard]] Meeting first_met(Point3 from, Point3 direction) const;

  // Calls visit(s, t) once for each two triangles whose closed boxes have a point in common, or, in
  // every coordinate, lie no more than `reach` apart; visit returns true to stop.
  void visit_meeting_boxes(const std::function<bool(std::int32_t, std::int32_t)>& visit,
                           double reach = 0) const;

 private:
  struct Node {
    Point3 low;
    Point3 high;
    std::int32_t begin = 0;  // leaf: range of items; inner: right child, left is the next node
    std::int32_t count = 0;  // 0: inner node
    std::int32_t parent = -1;
  };
  struct Item {
    Point3 a, b, c;
    std::int32_t triangle;
    std::int32_t leaf = 0;  // its node
  };

  struct Centroid {
    std::array<double, 3> sum;  // of the corners
    std::int32_t triangle;
  };

  template <class MakeItem>
  std::int32_t build(std::span<Centroid> order, const MakeItem& item);
  template <class Visit>
  bool search_below(std::int32_t root, Point3 p, double& squared_reach, const Visit& visit) const;
  void look_along(std::int32_t node, Point3 from, Point3 direction, Meeting& first) const;
  template <class Visit>
  void search(Point3 p, double& squared_reach, std::int32_t last, const Visit& visit) const;

  std::vector<Node> nodes_;
  std::vector<Item> items_;
};

}  // namespace symcell
