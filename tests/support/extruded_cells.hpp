// Symmetry cells of solids made by hand: planar samples extruded along an axis of any place and
// direction, three tetrahedra a prism, with the models they mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/geometry/axis_frame.hpp"
#include "core/model/plc.hpp"
#include "core/model/pslg.hpp"

namespace symcell::test {

inline constexpr std::int32_t kBottomMarker = 11;
inline constexpr std::int32_t kTopMarker = 12;
inline constexpr std::int32_t kPlateMarker = 13;

struct Extrusion {
  std::int32_t layers = 2;
  double height = 1.5;
  // A plate between the first layer and the others: an internal facet, whose region numbers differ
  // by 10. Needs two layers.
  bool plate = false;
  AxisFrame frame;  // the plane's origin goes to its origin, z to its axis
};

// `planar` must have its centre at the origin. Sides keep their markers.
[[nodiscard]] SymmetryCellMesh extruded_cell(const SymmetryCellMesh& planar, const Extrusion& how);
// `planar` must consist of closed polygons about the origin, the outer one last if there are two.
[[nodiscard]] Plc extruded_model(const Pslg& planar, const Extrusion& how);
// Of the full model.
[[nodiscard]] double extruded_volume(const Pslg& planar, const Extrusion& how);

struct SolidSample {
  const char* name;
  Plc model;
  SymmetryCellMesh cell;
  double volume;  // of the full model
};

// Rings n = 6 with crooked bounds, n = 5 with one column a sector, n = 2 with a plate about a
// skew axis, n = 1; prisms with the axis inside n = 5 and n = 3 (skew, far from the origin).
[[nodiscard]] std::vector<SolidSample> solid_samples();

}  // namespace symcell::test
