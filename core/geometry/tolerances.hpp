// Tolerances and units that more than one room must agree on.
#pragma once

#include <numbers>

namespace symcell {

inline constexpr double kRadiansADegree = std::numbers::pi / 180;  // factor on degrees

// How far a facet's vertices may lie off its plane, as a share of the model's diameter: what is
// accepted of a PLC, and by what its facets in the mesh may differ from those given.
inline constexpr double kPlanarityToleranceRel = 1e-7;

// By what two sums of rounded lengths or areas may differ, as a share of the sum and of the longest
// length: above the roundings of a sum of millions, far below a missing piece.
inline constexpr double kSumRoundingRel = 1e-9;

// Factor on the bounds of lifted predicates (lifted_predicates.hpp of both wings) when a finished
// mesh is checked. A tie left alone when its points were inserted may look certain with other
// roundings: each is off by less than the bound, so by less than three bounds in all.
inline constexpr double kTieSlack = 4;

}  // namespace symcell
