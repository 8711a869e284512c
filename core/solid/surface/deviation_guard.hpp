// Keeps a changing surface within a distance of what it was, both ways.
//
// Forth: points of a new triangle lie near the old surface, which faces the same way there. Back:
// samples of the old surface (corners, middles) each lie near the triangle that answers for them.
// Nothing accumulates: the old surface stays the measure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/triangle_tree.hpp"
#include "core/solid/surface/editable_surface.hpp"

namespace symcell::solid {

class DeviationGuard {
 public:
  DeviationGuard(const QuotientSurface& surface, double most);

  [[nodiscard]] double most() const { return most_; }
  // From now on more deviation is allowed.
  void relax(double factor) { most_ *= factor; }

  // Whether triangles `gone` may become `planned` (some of the same ids); then `answers` are the
  // planned triangle (index) that each sample of the gone ones goes to.
  [[nodiscard]] bool allows(std::span<const std::int32_t> gone,
                            std::span<const PlannedTriangle> planned);
  // The same where the union of the triangles does not change: always allowed.
  void follow(std::span<const std::int32_t> gone, std::span<const PlannedTriangle> planned);
  // Makes the last answer true.
  void commit(std::span<const std::int32_t> gone, std::span<const PlannedTriangle> planned);

  // Triangle `t` had the number old[t] before.
  void renumber(const std::vector<std::int32_t>& old);

  // Mean height of the old surface over triangle `triangle` with these corners.
  [[nodiscard]] double mean_height(std::int32_t triangle, const std::array<Point3, 3>& points);

  // The point of the old surface nearest to p, if it is near.
  [[nodiscard]] TriangleTree::Hit nearest(Point3 p, double reach) const {
    return tree_.nearest(p, reach);
  }

 private:
  [[nodiscard]] bool lies_on_old_surface(const PlannedTriangle& triangle);
  [[nodiscard]] std::int32_t& hint_of(std::int32_t triangle);
  [[nodiscard]] bool answers(std::span<const std::int32_t> gone,
                             std::span<const PlannedTriangle> planned,
                             double reach);

  double most_;
  TriangleTree tree_;
  std::vector<Point3> normals_;  // of the old triangles, as the input had them
  std::vector<Point3> samples_;
  std::vector<std::vector<std::int32_t>> of_triangle_;  // samples each triangle answers for
  std::vector<std::int32_t> hints_;  // where in the tree each triangle was found last
  std::vector<std::pair<std::int32_t, std::int32_t>> answers_;  // sample, index in `planned`
};

}  // namespace symcell::solid
