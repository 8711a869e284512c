// Random planar models cut from a grid of cells (sector_grid.hpp), made from a seed alone: combs,
// gears, stars of bars, several and nested holes, islands, regions that touch, thin webs, segments
// that end inside others or nowhere, any fold and size.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/model/pslg.hpp"
#include "tests/support/model_topology.hpp"

namespace symcell::test {

struct RandomPlanarCells {
  Pslg pslg;
  std::string description;
  std::int32_t fold = 1;  // the model may happen to have a multiple of it
  Point2 center;
  double scale = 1;             // about the outer radius
  double area = 0;              // of the meshed domain
  std::vector<Point2> pinches;  // where material touches itself in a vertex
  BoundaryTopology boundary;    // euler: vertices - edges
};

// `fold`: nullopt: random, 1 and large ones among them.
[[nodiscard]] RandomPlanarCells make_random_planar_cells(std::uint64_t seed,
                                                         std::optional<std::int32_t> fold = {});

}  // namespace symcell::test
