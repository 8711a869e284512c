// A solid of stacked prisms: the cells of a grid, filled or not layer by layer. Boxes of cells are
// added and cut at random, so ribs, tabs, teeth, spokes, pockets, through holes, islands and
// cavities arise by themselves, and what faces them is known exactly.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/random.hpp"
#include "tests/support/model_topology.hpp"
#include "tests/support/sector_grid.hpp"

namespace symcell::test {

struct LayeredCells {
  SectorGrid grid;
  std::vector<double> heights;     // of the levels, one more than layers
  double taper = 0;                // at height z all is scaled by 1 + taper z
  std::vector<std::int32_t> fill;  // [layer][cell]: 0: nothing, else the kind of material
  std::string description;

  [[nodiscard]] std::int32_t layers() const {
    return static_cast<std::int32_t>(heights.size()) - 1;
  }
  // Nothing beyond the grid: layers below and above, cell -1.
  [[nodiscard]] std::int32_t material(std::int32_t layer, std::int32_t cell) const;
  [[nodiscard]] Point3 position(Point2 p, double z) const;
  [[nodiscard]] Point3 position(std::int32_t point, std::int32_t level) const;
  [[nodiscard]] double volume() const;
};

struct LayeredOptions {
  std::int32_t layers = 4;  // at most
  std::int32_t kinds = 3;   // of material, at most
  bool pinches = false;     // may be left; else what pinches is filled or emptied
  bool tabs = false;        // a body with tabs on its sides and pockets in them
};

[[nodiscard]] LayeredCells make_layered_cells(Random& random,
                                              std::int32_t fold,
                                              const LayeredOptions& options);

[[nodiscard]] Pinches pinches_of(const LayeredCells& cells);
[[nodiscard]] BoundaryTopology boundary_topology(const LayeredCells& cells);

}  // namespace symcell::test
