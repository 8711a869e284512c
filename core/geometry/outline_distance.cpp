#include "core/geometry/outline_distance.hpp"

#include <limits>

namespace symcell {
namespace {

constexpr double kAnyDistance = std::numeric_limits<double>::infinity();
// Halvings of a segment: a 2^-40th of the largest is below what its coordinates resolve.
constexpr int kMostHalvings = 40;

struct End {
  Point2 point;
  SegmentIndex::Hit hit;
};

class Search {
 public:
  Search(const SegmentIndex& index, double resolution) : index_(index), resolution_(resolution) {}

  double run(Point2 a, Point2 b) {
    const End from = end_at(a), to = end_at(b);
    if (from.hit.segment < 0) return kAnyDistance;
    split(from, to, 0);
    return largest_;
  }

 private:
  End end_at(Point2 p) {
    const End end{p, index_.nearest(p, kAnyDistance)};
    largest_ = std::max(largest_, end.hit.distance);
    return end;
  }

  // The distance from one segment is convex along another: where one is nearest at both ends, no
  // point between is farther than the ends. Elsewhere the distance grows by no more than the way.
  void split(const End& a, const End& b, int halvings) {
    if (a.hit.segment == b.hit.segment || halvings == kMostHalvings) return;
    const double way = distance(a.point, b.point);
    const double most = 0.5 * (a.hit.distance + b.hit.distance + way);
    if (most <= largest_ + resolution_) return;
    const End middle = end_at(a.point + 0.5 * (b.point - a.point));
    split(a, middle, halvings + 1);
    split(middle, b, halvings + 1);
  }

  const SegmentIndex& index_;
  double resolution_;
  double largest_ = 0;
};

}  // namespace

double outline_distance(const SegmentIndex& index, Point2 a, Point2 b, double resolution) {
  return Search(index, resolution).run(a, b);
}

}  // namespace symcell
