// Where a vertex may lie so that every triangle of its star keeps all bounds.
//
// For a star polygon with edges a -> b the triangles (a, b, x) have all angles >= alpha exactly if
// x lies in two half-planes (rays from a and b at angle alpha) and in one disc (the chord ab seen
// under alpha); the area bound is one more half-plane, the edge bound two more discs. All are
// convex, so the feasible region is, and a centroid cutting-plane search finds a point of it, near
// its middle, unless it is empty or very thin. Source: the petals and wedges of [Erten-Ungor09],
// here solved as one convex problem.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/point.hpp"
#include "core/model/mesh_options.hpp"

namespace symcell::plane {

struct StarEdge {
  Point2 a;
  Point2 b;
  double max_area = kInfinity;
  double reach = kInfinity;  // how far x may be from a, where that is less than the edge bound
};

class FeasibleRegion {
 public:
  // `alpha`: radians, in (0, pi/3).  `max_edge2`: squared edge bound, inf: none.
  FeasibleRegion(double alpha, double max_edge2);

  // A point with all triangles (a, b, x) good, near the middle of all such points.
  // `edges`: counter-clockwise.
  [[nodiscard]] std::optional<Point2> find(const std::vector<StarEdge>& edges);

  // The same for x on the line p + t d, t in (0, 1): the middle of the feasible interval.
  [[nodiscard]] std::optional<Point2> find_on_line(const std::vector<StarEdge>& edges,
                                                   Point2 p,
                                                   Point2 d) const;

  [[nodiscard]] std::size_t most_edges() const { return most_edges_; }

 private:
  struct Disc {
    Point2 centre;
    double radius;
  };

  [[nodiscard]] Disc disc_of(const StarEdge& e) const;
  // Keeps the part of the polygon with dot(normal, x) <= offset; false if nothing is left.
  bool clip(Point2 normal, double offset);
  [[nodiscard]] bool clip_by_wedges(const std::vector<StarEdge>& edges, Point2 origin);
  [[nodiscard]] static bool too_large(const std::vector<StarEdge>& edges, Point2 origin);
  [[nodiscard]] bool start(const std::vector<StarEdge>& edges, Point2 origin);

  double alpha_;
  double sine_, cosine_, half_cotangent_, half_cosecant_;
  double max_edge_, max_edge2_;
  std::size_t most_edges_;  // more triangles than this cannot all have alpha at x
  std::vector<Point2> polygon_, next_;
  std::vector<double> side_;
  std::vector<Disc> discs_;
  std::vector<std::size_t> order_;
};

}  // namespace symcell::plane
