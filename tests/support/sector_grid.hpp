// A part of the plane divided into cells, n-fold about the origin: rings and columns (round,
// uneven, or straight along the sides of a polygon), arms that stand on the sides, or a grid of
// rectangles. What models are cut from: cells are filled and hollow, facets lie between.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/point.hpp"

namespace symcell::test {

// Ids of an orbit are equal for copies of each other under the rotations.
struct GridCell {
  std::vector<std::int32_t> corners;  // points, counter-clockwise
  std::int32_t orbit = 0;
  std::int32_t u = 0;   // ring or place in x
  std::int32_t v = 0;   // column or place in y; -1: all round
  bool hollow = false;  // never filled: a bore
  bool outer = false;   // of an arm, or at the rim of the rectangles
};

// The cells at its sides, -1 where there is none. Edges of one line lie on one straight line and
// run the same way.
struct GridEdge {
  std::int32_t a = 0;
  std::int32_t b = 0;
  std::int32_t left = -1;
  std::int32_t right = -1;
  std::int32_t line = 0;
  std::int32_t orbit = 0;
};

struct SectorGrid {
  std::int32_t fold = 1;
  std::vector<Point2> points;
  std::vector<std::int32_t> point_orbit;
  std::vector<GridCell> cells;
  std::vector<GridEdge> edges;
  std::vector<std::vector<std::int32_t>> edges_at;  // per point
  std::int32_t lines = 0;
  std::int32_t cell_orbits = 0;
  std::int32_t rings = 0;    // u is below it
  std::int32_t columns = 0;  // v likewise
  bool arms = false;         // their outer cells of one column make one arm
  std::string description;

  // The cell's whole outline is seen from there.
  [[nodiscard]] Point2 middle(std::int32_t cell) const;
  [[nodiscard]] double area(std::int32_t cell) const;
  // From point a to b of a cell's outline: the edge.
  [[nodiscard]] std::int32_t edge_between(std::int32_t a, std::int32_t b) const;
};

// All of it lies within a radius of about 1 (arms: 3).  `tabs`: there are outer cells, none of them
// at a corner, and cells beside them that may stay empty.  Requires: fold >= 1; tabs: up to 12.
[[nodiscard]] SectorGrid make_sector_grid(Random& random, std::int32_t fold, bool tabs = false);

}  // namespace symcell::test
