// A mesh as a file gives it: plain coordinates and indices, nothing taken for granted. What
// verify_mesh looks at; meshes of our own making are SymmetryCellMesh.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {

struct MeshData {
  std::int32_t dimension = 2;
  std::int32_t order = 1;
  std::int32_t fold = 1;
  double shape_tolerance_rel = 0;  // as in SymmetryCellMesh
  Point3 axis_origin;
  Point3 axis_direction{0, 0, 1};

  std::vector<Point3> points;
  // Solids of order 2: edges of the boundary may follow curved faces. Nothing in a file says so.
  bool curved = false;
  bool single_precision = false;  // the file has coordinates of 32 bits
  std::int32_t nodes_per_element = 3;
  std::vector<std::int32_t> elements;  // indices of points, each in range
  std::vector<std::int32_t> regions;   // per element
  std::vector<std::int32_t> markers;   // per point; empty: the file has none

  // Of a cell: per point, -1 where there is none. Of a full mesh: empty.
  std::vector<std::int32_t> lower_to_higher;
  // Of a full mesh: per element. Of a cell: empty.
  std::vector<std::int32_t> sectors;
  std::vector<std::int32_t> cell_elements;

  [[nodiscard]] std::size_t element_count() const {
    return elements.size() / static_cast<std::size_t>(nodes_per_element);
  }
};

}  // namespace symcell
