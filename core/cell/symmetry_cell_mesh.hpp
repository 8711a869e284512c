// The result of meshing: one symmetry cell, compact, from which the full mesh is streamed.
//
// Everything is orbits and exponents; coordinates exist once per orbit. Serves 2D and 3D: in 2D the
// axis is (0, 0, 1), `z` is 0 and facets are edges.
//
// Invariants:
// - node i of the cell is rotation^exponent of orbit_points[orbit]; no two nodes are equal as
//   (orbit, exponent) pairs; every orbit has at least one node; axis orbits have exponent 0 only;
// - elements are positively oriented (2D: counter-clockwise; 3D: (1 - 0) x (2 - 0) . (3 - 0) > 0);
//   order 2: mid-side nodes follow the corners in VTK's order (triangle6: edges 01, 12, 20;
//   tetrahedron10: 01, 12, 02, 03, 13, 23);
// - lower_to_higher[i] is the index of the cell node that is the image of node i under +360/n
//   degrees if i lies on the lower bound, -1 elsewhere; a node on the axis maps to itself (n > 1);
// - rotating the cell by all n exponents gives every element of the full mesh exactly once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/orbit_vertex.hpp"
#include "core/geometry/point.hpp"
#include "core/geometry/rotation.hpp"
#include "core/model/pslg.hpp"

namespace symcell {

struct SymmetryCellMesh {
  std::int32_t dimension = 2;
  std::int32_t order = 1;
  std::int32_t fold = 1;
  // Planar: not 0 where the mesh follows the model's segments to within this share of its diameter
  // but need not have its vertices; the checker holds it to that.
  float shape_tolerance_rel = 0;

  // Frame of the axis: orbit_points are relative to `axis_origin` in the orthonormal frame whose
  // third column is `axis_direction`; 2D uses the identity.
  Point3 axis_origin;
  Point3 axis_direction{0, 0, 1};
  std::array<double, 9> frame{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major: model = frame * local

  std::vector<Point3> orbit_points;   // local frame, one per orbit
  std::vector<std::uint8_t> on_axis;  // per orbit: 1 if on the axis (one copy only)

  std::vector<OrbitVertex> nodes;          // cell nodes
  std::vector<std::int32_t> node_markers;  // per cell node
  std::int32_t nodes_per_element = 3;      // 3, 6 (2D) or 4, 10 (3D)
  std::vector<std::int32_t> elements;      // node indices, nodes_per_element each
  std::vector<std::int32_t> regions;       // per element: region attribute in sector 0

  // Facets of the cell (edges in 2D) on input segments or facets, internal ones too.
  std::int32_t nodes_per_facet = 2;  // 2, 3 (2D) or 3, 6 (3D)
  std::vector<std::int32_t> boundary;
  std::vector<std::int32_t> boundary_markers;
  // 1 for a facet on the higher bound: the full mesh already has it as the image of a lower one.
  std::vector<std::uint8_t> boundary_is_higher_image;

  // Per facet that of the arc which it is a chord of, from its first to its second node
  // (core/geometry/arc.hpp); empty: all are straight. For elevating to order 2; not stored with a job.
  std::vector<double> boundary_bulges;

  std::vector<MarkerName> marker_names;  // of the model

  // The bounds: facet i of `lower` is mapped by +360/n onto facet i of `higher`, node by node.
  std::vector<std::int32_t> lower_facets;  // nodes_per_facet each
  std::vector<std::int32_t> higher_facets;
  std::vector<std::int32_t> lower_to_higher;  // per cell node

  // Only if regions or markers differ between sectors (ignore_markers): element e in sector s has
  // region sector_regions[e * fold + s], boundary facet b marker sector_boundary_markers[b * fold +
  // s].
  std::vector<std::int32_t> sector_regions;
  std::vector<std::int32_t> sector_boundary_markers;

  [[nodiscard]] std::size_t element_count() const {
    return elements.size() / static_cast<std::size_t>(nodes_per_element);
  }
  [[nodiscard]] std::size_t facet_count() const { return boundary_markers.size(); }
  [[nodiscard]] std::int32_t region(std::size_t element, std::int32_t sector) const {
    return sector_regions.empty() ? regions[element]
                                  : sector_regions[element * static_cast<std::size_t>(fold) +
                                                   static_cast<std::size_t>(sector)];
  }
  [[nodiscard]] std::int32_t boundary_marker(std::size_t facet, std::int32_t sector) const {
    return sector_boundary_markers.empty()
               ? boundary_markers[facet]
               : sector_boundary_markers[facet * static_cast<std::size_t>(fold) +
                                         static_cast<std::size_t>(sector)];
  }
};

}  // namespace symcell
