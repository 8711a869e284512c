// Random plane models that are symmetric in shape only: circles as polygons out of phase, left-over
// vertices, profiles sampled differently in every sector, noise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/pslg.hpp"

namespace symcell::test {

struct ShapeModel {
  Pslg pslg;
  std::int32_t fold = 1;
  double tolerance_rel = 0;  // of the diameter, with which the fold is there
  std::string description;
};

// The same for the same seed. About the origin, of a size near 1.
[[nodiscard]] ShapeModel make_shape_model(std::uint64_t seed);

// A polygon of `sides` about `centre`, counterclockwise; the first corner at angle `phase`.
[[nodiscard]] std::vector<Point2> polygon(std::int32_t sides,
                                          double radius,
                                          double phase,
                                          Point2 centre);

// A ring of radius near 1 whose rim of 2,000 vertices has seven waves, with a bore of 1,000.
[[nodiscard]] Pslg wavy_ring();

// Adds a closed loop.
void add_loop(Pslg& pslg, const std::vector<Point2>& points, std::int32_t marker);

}  // namespace symcell::test
