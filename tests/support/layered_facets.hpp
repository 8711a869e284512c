// The faces between the prisms of a stack, plane by plane, and facets made of them: groups of faces
// that touch, with their outlines, the holes in these and the islands in the holes.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "tests/support/layered_cells.hpp"

namespace symcell::test {

// Corners are vertices (level * points + point), counter-clockwise seen from the front.
struct SheetFace {
  std::vector<std::int32_t> corners;
  std::vector<std::int32_t> neighbours;   // beyond the side from corner i to i + 1, -1: none
  std::vector<std::int64_t> lines;        // of the sides: equal ones of one sheet are collinear
  std::vector<std::int64_t> side_orbits;  // likewise, equal for copies
  std::int32_t front = 0;                 // the materials
  std::int32_t back = 0;
  std::int64_t orbit = 0;  // equal for copies of each other only
  std::int32_t kind = 0;   // 1: below material, 2: on top of it, 3: a wall, 4: within material
  Point3 middle;
};

// All faces of one plane, those that bound nothing too.
using Sheet = std::vector<SheetFace>;

[[nodiscard]] std::vector<Sheet> make_sheets(const LayeredCells& cells);

struct OutlineCorner {
  std::int32_t vertex = 0;
  bool straight = false;  // the outline runs straight on
  std::int64_t line = 0;  // of the side that comes to it
};

// A group of faces of a sheet that hang together by sides.
struct FacetOutline {
  std::vector<std::vector<OutlineCorner>> loops;
  std::vector<std::array<std::int32_t, 2>> seams;  // sides within
  std::vector<std::int32_t> inner;                 // vertices on no loop
  std::vector<Point3> holes;                       // a point in each part of the plane left out
  std::int32_t face = 0;                           // one of the sheet's
};

// `wanted`: per face; `joins`: whether two wanted faces that share side i of the first are one.
[[nodiscard]] std::vector<FacetOutline> make_outlines(
    const Sheet& sheet,
    const std::vector<char>& wanted,
    const std::function<bool(const SheetFace&, std::size_t, const SheetFace&)>& joins);

}  // namespace symcell::test
