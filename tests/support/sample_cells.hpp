// Symmetry cells made by hand, with the models they mesh: what formats and checks are tested on
// without running the mesher.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/model/pslg.hpp"

namespace symcell::test {

struct Sample {
  const char* name;
  Pslg model;
  SymmetryCellMesh cell;
};

struct RingShape {
  std::int32_t fold = 6;
  std::int32_t steps = 3;   // edges of a circle a sector
  std::int32_t layers = 2;  // from inner to outer circle
  double inner_radius = 1;
  double outer_radius = 2;
  double swirl = 0;  // radians by which the outer circle is turned: crooked bounds
  Point2 center{0, 0};
};

// A ring between two polygons; inner boundary marker 1, outer 2.  For fold 1: steps >= 3, no
// bounds.
[[nodiscard]] SymmetryCellMesh ring_cell(const RingShape& shape);
[[nodiscard]] Pslg ring_model(const RingShape& shape);

// A regular polygon with `fold * steps` corners and a node at the centre, region 7, marker 3.
[[nodiscard]] SymmetryCellMesh disc_cell(std::int32_t fold, std::int32_t steps, Point2 center);
[[nodiscard]] Pslg disc_model(std::int32_t fold, std::int32_t steps, Point2 center);

// The unit square cut once, fold 1, a marker a side (1 to 4), two regions split by a segment
// (marker 5).
[[nodiscard]] SymmetryCellMesh square_cell();
[[nodiscard]] Pslg square_model();

// Ring n=6 with crooked bounds, ring n=2, ring n=1, disc n=5, disc n=3 off centre, square.
[[nodiscard]] std::vector<Sample> all_samples();

}  // namespace symcell::test
