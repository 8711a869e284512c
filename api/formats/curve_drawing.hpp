// Drawings as planar models: curves given by the places of their ends, which become vertices that
// segments share. Arcs stay arcs; ellipses and splines become arcs that run within 1e-4 of their
// length beside them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/error.hpp"
#include "core/model/pslg.hpp"

namespace symcell {

class CurveDrawing {
 public:
  // Curves of no length, and those that go between the same ends in the same way as another of the
  // same marker, are dropped.  `bulge`: core/geometry/arc.hpp.
  void add_arc(Point2 a, Point2 b, double bulge, std::int32_t marker);
  // centre + cos t * u + sin t * v for t from `from` to `to`, in radians, a full turn at most.
  void add_ellipse(Point2 centre, Point2 u, Point2 v, double from, double to, std::int32_t marker);
  // A smooth curve by its places at t from `from` to `to`.
  void add_curve(const std::function<Point2(double)>& at,
                 double from,
                 double to,
                 std::int32_t marker);

  [[nodiscard]] std::size_t size() const { return curves_.size(); }

  // Adds vertices and segments to a model without any; ends nearer to each other than 1e-9 of the
  // diameter are one vertex.  Errors: kTooLarge.
  [[nodiscard]] Result<void> finish(Pslg& pslg) const;

 private:
  struct Curve {
    Point2 a;
    Point2 b;
    double bulge = 0;
    std::int32_t marker = 0;
  };
  void add_through(const std::function<Point2(double)>& at,
                   double from,
                   double to,
                   std::int32_t marker,
                   int depth);

  std::vector<Curve> curves_;
};

}  // namespace symcell
