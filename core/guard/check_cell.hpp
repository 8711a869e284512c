// The last look at a finished symmetry cell, triangles or tetrahedra, before it is handed out. It
// reads the arrays that are written, and shares no code with what made them.
//
//   fields    arrays of fitting lengths, indices in range
//   nodes     each used, no two the same copy of an orbit, on the axis exponent 0, one an orbit
//   elements  distinct corners, none turned inside out; inner facets have two, on opposite sides
//   bounds    lower facets go to higher ones node by node, by one step of rotation, and are seen
//             from the other side; a facet of one element is on a bound or listed as boundary
//   listed    facets of the boundary are facets of elements, each once, marked as images on the
//             higher bound only
//   pairs     nodes of lower facets with those of the higher ones, on the axis with themselves
//   links     elements round a node, in space an edge too, hang together by facets, but where the
//             boundary of the full mesh touches itself
//   boundary  in space: shells, Euler characteristic and pinches as of the facets covered
//
// Facets inside are matched by a sum of random numbers in which the two sides of a facet cancel;
// only what touches the cell's surface is matched in a table: the cost is some hundred nanoseconds
// an element.
#pragma once

#include "core/base/error.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/guard/boundary_topology.hpp"

namespace symcell {

// `cell`: of order 1.  `boundary`: of a solid, of the surface that was to be meshed; null: not
// compared.  Errors: kInternal, naming the entity.
[[nodiscard]] Result<void> check_cell(const SymmetryCellMesh& cell,
                                      const BoundaryTopology* boundary = nullptr);

}  // namespace symcell
