// The cells into which the facets of a complex divide space, without meshing it: walking round
// edges joins the sides of facets to shells, rays find which shells bound one cell.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/plc/plc_complex.hpp"

namespace symcell::solid {

inline constexpr std::int32_t kOutside = 0;  // the cell that is not enclosed

struct PlcCell {
  double volume = 0;         // 0 for the outside
  std::int32_t hole = -1;    // hole seed in it, -1: none
  std::int32_t region = -1;  // region seed in it, the first
  bool meshed = false;       // enclosed and without hole seed
};

struct PlcCells {
  std::vector<PlcCell> cells;  // cell 0 is the outside
  // Per facet and triangle: the cells on the side its normal looks to and on the other.
  std::vector<std::vector<std::array<std::int32_t, 2>>> sides;
  // Per facet and segment of its graph: its triangles to the left and right of a -> b, seen against
  // its normal; -1: none.
  std::vector<std::vector<std::array<std::int32_t, 2>>> borders;
  std::vector<std::int32_t> hole_cell;    // per hole seed
  std::vector<std::int32_t> region_cell;  // per region seed
  // Segments at which one triangle ends: rims of what encloses nothing.
  std::vector<std::int32_t> open_edges;
  double volume = 0;  // of all meshed cells
};

// Requires: the complex conforms and nothing crosses.
// Errors: kInternal if a ray finds no clear way (not met in practice), limits.
// Cost: O(n log n) as a rule; a box query a shell and seed.
[[nodiscard]] Result<PlcCells> find_cells(const PlcComplex& complex, ExecutionContext& context);

// What the seeds must hold: something is enclosed, every seed lies in an enclosed cell, no cell has
// a hole and a region seed or two regions that differ, something is left to mesh.  Errors:
// kNotWatertight, kUnreachableSeed, kConflictingSeeds, kDegenerateGeometry.
[[nodiscard]] Result<void> check_cells(const PlcComplex& complex, const PlcCells& cells);

}  // namespace symcell::solid
