// One polyline for all copies of a chain, which run along each other but have vertices of their own.
//
// Vertices that all copies have are kept, at their mean. Between these the vertices are chosen, out
// of those of several copies, so that the sum over all edges of 1 + (d / e)^2 / 4 is least, where d
// is how far the edge passes the vertices that it skips and e how far the copies differ. A vertex
// that stands on a straight part is then dropped, and a polygon that is out of phase with the fold
// gets edges of even length, about as long as it had.
#pragma once

#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/point.hpp"

namespace symcell::plane {

struct FittedChain {
  std::vector<Point2> points;  // without the two ends
  double asymmetry = 0;        // how far the copies are from one of them
  // Of the vertices that all copies have, their number and, per copy, the sum of their places in
  // that copy less their means: where the copies would rather have their frames.
  std::size_t shared = 0;
  std::vector<Point2> shifts;
};

struct ChainFitRequest {
  Point2 first;  // where the polyline starts and ends
  Point2 last;
  double tolerance = 0;   // that no point may be moved by more than
  double resolution = 0;  // below which positions are the same; both in input units
  // An edge may pass by what it skips at so many times what the copies differ by.
  double most_asymmetries = 2;
};

// `copies`: polylines in one frame and direction, with both ends, which need not lie exactly at the
// ends of the request.
// Errors: kNotSymmetric if the copies do not run along each other; kCancelled, kTimeLimit.
// Cost: O(N log N) for N points of all copies, but that a point is compared with up to some hundred.
[[nodiscard]] Result<FittedChain> fit_chain(std::span<const std::vector<Point2>> copies,
                                            const ChainFitRequest& request,
                                            ExecutionContext& context);

// Positions along `line`, as lengths from its start, at which `points` in their order come nearest.
// Empty if one is farther away than `reach`.
[[nodiscard]] std::vector<double> places_along(std::span<const Point2> line,
                                               std::span<const Point2> points,
                                               double reach);

}  // namespace symcell::plane
