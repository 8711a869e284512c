// Arcs of one circle that go on from one another, as one.
#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "core/geometry/point.hpp"
#include "core/model/pslg.hpp"

namespace symcell::plane {

// A part of a circle from vertex to vertex, counter-clockwise as seen from the centre if `angle` is
// positive.
struct ArcChain {
  std::int32_t a = -1;  // -1: a whole circle without a vertex that must stay
  std::int32_t b = -1;
  std::int32_t marker = 0;
  Point2 centre;
  double radius = 0;
  double angle = 0;                    // radians
  std::vector<std::int32_t> joints;    // vertices between, in order; of a circle the first, too
  std::vector<std::int32_t> segments;  // of the model, each once, in order; may be shared by chains
  int doublings = 0;                   // of the number of chords
  bool ends_joined_twice = false;      // by a line or another arc
  [[nodiscard]] bool whole() const { return a < 0; }
};

struct ArcChains {
  std::vector<ArcChain> chains;
  std::vector<char> is_joint;  // per vertex
};

// `tolerance`: distance within which a vertex is on an arc, and circles are one.
// `keeps`: per vertex: it ends chains, whatever meets there.
// Requires: indices in range, no segment of length zero, bulges finite.  Cost: O(N log N).
[[nodiscard]] ArcChains chain_arcs(const Pslg& pslg,
                                   double tolerance,
                                   const std::vector<char>& keeps);

}  // namespace symcell::plane
