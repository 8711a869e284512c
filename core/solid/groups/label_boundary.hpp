// The groups of a surface as markers of a finished cell's boundary.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/solid/groups/face_groups.hpp"

namespace symcell::solid {

// Marks the boundary facets of `cell` with the groups of the surface's triangles that they lie on,
// and its nodes with the smallest marker of their facets. The mesh stays as it is: where a group
// ends without an edge of the mesh (at names of the file on a smooth part), it ends at the facets
// that lie on it for their larger part.
// `cell`: of order 1, without markers.  `surface`, `tree`: in the cell's local frame.
// Errors: limits.  Cost: O(F log T) for F facets, where the file names groups times the fold.
[[nodiscard]] Result<void> label_boundary(const FaceGroups& groups,
                                          const IndexedSurface& surface,
                                          const TriangleTree& tree,
                                          SymmetryCellMesh& cell,
                                          ExecutionContext& context);

}  // namespace symcell::solid
