// A tree of boxes over triangles: the nearest point of a surface, within a reach.
//
// Built by splitting at the median centroid along the longest side. An own tree and not CGAL's:
// the queries here are bounded ("is the surface within 1e-3 of here?"), which lets most of them end
// after one leaf.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/geometry/point.hpp"
#include "core/surface/indexed_surface.hpp"

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
  // The same for a point near one that was looked for before: `last`, -1 at first, tells where the
  // search begins, not what it finds.
  [[nodiscard]] Hit nearest(Point3 p, double reach, std::int32_t& last) const;
  // Any triangle no farther than `reach`.
  [[nodiscard]] bool within(Point3 p, double reach) const {
    std::int32_t last = -1;
    return within(p, reach, last);
  }
  // The same for points near each other: what was found last is looked at first. `last`: -1 at
  // first.
  [[nodiscard]] bool within(Point3 p, double reach, std::int32_t& last) const;

 private:
  struct Node {
    Point3 low;
    Point3 high;
    std::int32_t begin = 0;  // leaf: range of items; inner: right child, left is the next node
    std::int32_t count = 0;  // 0: inner node
  };
  struct Item {
    Point3 a, b, c;
    std::int32_t triangle;
  };

  std::int32_t build(std::int32_t begin, std::int32_t end);
  template <class Visit>
  void search(Point3 p, double& squared_reach, const Visit& visit) const;

  std::vector<Node> nodes_;
  std::vector<Item> items_;
};

}  // namespace symcell
