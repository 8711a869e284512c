// How well a shape maps onto itself when turned about an axis, and the axis for which it does so
// best. Distances are between points of the surface and the surface: its triangles need not match.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/point.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/model/mesh_options.hpp"  // kInfinity

namespace symcell::solid {

struct SymmetryAxis {
  Point3 origin;
  Point3 direction{0, 0, 1};  // unit length
};

struct ShapeError {
  double distance = 0;     // input units
  Point3 worst;            // the point that lies so far from the surface once turned
  std::int32_t steps = 0;  // by how many n-ths of a full turn
};

class ShapeSymmetry {
 public:
  // `surface` is kept by reference.  `diameter`: of the bounding box.
  ShapeSymmetry(const IndexedSurface& surface, double diameter);

  // Of one turn, by steps / fold of a full one: the largest distance of a sample of the surface.
  // Stops where it exceeds `enough`.  Errors: limits.  Cost: a share of a second for all turns of
  // a fold together.
  [[nodiscard]] Result<ShapeError> turn_error(const SymmetryAxis& axis,
                                              std::int32_t steps,
                                              std::int32_t fold,
                                              double enough,
                                              ExecutionContext& context) const;

  // The worst of all turns of a fold.
  [[nodiscard]] Result<ShapeError> error(const SymmetryAxis& axis,
                                         std::int32_t fold,
                                         double enough,
                                         ExecutionContext& context) const;

  // Whether a few points, turned by `angle`, stay within `reach` of the surface: false as a rule
  // after one or two distances.
  [[nodiscard]] bool fits(const SymmetryAxis& axis, double angle, double reach) const;

  // Root mean square distance of `count` points turned by `angle`, each at most `cap`; infinite as
  // soon as it is sure to be above `enough`.
  [[nodiscard]] double mean_error(const SymmetryAxis& axis,
                                  double angle,
                                  double cap,
                                  std::size_t count,
                                  double enough = kInfinity) const;

  // Moves the axis so that the shape turned by `angle` fits best: point-to-plane Gauss-Newton with
  // weights against outliers.
  [[nodiscard]] SymmetryAxis refined(SymmetryAxis axis,
                                     double angle,
                                     bool move_origin,
                                     bool tilt) const;

 private:
  void choose_samples();
  [[nodiscard]] std::span<const Point3> samples_for(std::int32_t fold) const;

  const IndexedSurface& surface_;
  double diameter_;
  TriangleTree tree_;
  std::vector<Point3> vertices_;         // all, in random order: any first part is a fair sample
  std::vector<Point3> spread_;           // random points, evenly over the area
  mutable std::vector<Point3> samples_;  // of fold samples_fold_
  mutable std::int32_t samples_fold_ = 0;
  mutable std::vector<std::size_t>
      discriminating_;  // samples of `fits`, the last that failed first
};

[[nodiscard]] Point3 turned(const SymmetryAxis& axis, double angle, Point3 p);

}  // namespace symcell::solid
