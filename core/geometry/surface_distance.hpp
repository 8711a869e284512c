// Whether triangles lie near a surface everywhere, and samples of a surface for what is looked at less strictly.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/triangle_tree.hpp"

namespace symcell {

// Vertices, middles of sides and of triangles, each once; neighbours follow each other.
[[nodiscard]] std::vector<Point3> samples_of(const IndexedSurface& surface);

// Looks for points of triangles that are farther than a reach from a surface (the one-sided Hausdorff
// distance, bounded): a triangle is taken apart until each part is near one triangle of the surface at
// all its corners. The distance from a triangle is convex, so the part is near it everywhere.
class DistanceBound {
 public:
  // The tree must outlive the bound.
  DistanceBound(const TriangleTree& surface, double reach) : surface_(&surface), reach_(reach) {}

  // A point of the triangle that is beyond reach; none if there is no such point. A part that is as near
  // as the reach, but for a share kSmallestPart of it, may be told as well.
  //
  // Cost: as a rule one query of the tree, and one for each triangle of the surface beside it. After
  // kMostParts parts of one triangle or kMostPartsInAll in all only middles of parts are looked at.
  [[nodiscard]] std::optional<Point3> beyond(const std::array<Point3, 3>& triangle);

 private:
  using Polygon = std::vector<Point3>;  // convex
  struct Part {
    Polygon corners;
    Point3 middle;
    double squared = 0;         // distance of the middle
    std::int32_t nearest = -1;  // to the middle; as `last_`
  };

  [[nodiscard]] bool is_near_at(std::span<const Point3> corners) const;
  void look_at(Polygon corners);
  void take_apart(const Part& part);
  [[nodiscard]] bool cut_out(const Part& part);
  void halve(const Polygon& corners, Point3 middle);

  const TriangleTree* surface_;
  double reach_;
  Point3 normal_;           // of the triangle, not of unit length
  std::int32_t last_ = -1;  // the triangle that was near last, for the tree
  std::size_t in_all_ = 0;
  std::vector<Part> parts_;  // not yet known, a heap: the farthest middle first
  std::optional<Point3> found_;
};

}  // namespace symcell
