// The faces of a surface as groups with numbers and names, alike in every copy.
//
// A face is what hangs together without an edge of the feature angle; copies of a face are one
// group. Names say what a group is where that is certain, and are counted, the largest first:
// `plane_1`, `cylinder_r12.5_1`, `hole_r4_1` (a hollow cylinder that closes), `cone_30deg_1`,
// `sphere_r2_1`, `torus_r20_1`, `surface_1`; about the axis of symmetry `bore` and `rim`, which faces of a
// few chords are together with their copies. Where the
// file names parts of its own these are the groups.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/face_group.hpp"
#include "core/geometry/axis_frame.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/triangle_surface.hpp"
#include "core/solid/groups/shape_fit.hpp"

namespace symcell::solid {

// The name of the smaller groups where there are more than can be told apart.
inline constexpr const char* kRestOfFaces = "rest";

struct FaceGroups {
  std::vector<FaceGroup> groups;          // by number, from 1; in the model's coordinates
  std::vector<ShapeFit> fits;             // likewise, of one of the faces, in the local frame
  std::vector<std::int32_t> of_triangle;  // number of a group; 0: none
  bool named = false;                     // by the file: copies may be in different groups
  // Pieces of groups that hang together, where they are asked for: of each its shape, and a number that
  // copies have in common.
  std::vector<std::int32_t> piece_of_triangle;
  std::vector<ShapeFit> piece_fits;
  std::vector<std::int32_t> class_of_piece;
};

struct GroupingOptions {
  std::optional<double> feature_angle_deg;  // as in MeshOptions
  std::int32_t fold = 1;
  AxisFrame frame;                     // of the axis of symmetry
  double reach = 0;                    // how far copies may be apart
  double noise = 0;                    // of coordinates
  std::optional<std::int32_t> sector;  // `given` is one of so many
  bool pieces = false;                 // are asked for
  double farthest = 0;                 // that the vertices of a piece may be from its shape
};

// `surface`: closed, in the local frame.  `tree`: of it.  `given`: the model as read, for its names.
// No groups: the feature angle is 0 and the model names none.  Errors: limits.
[[nodiscard]] Result<FaceGroups> find_face_groups(const IndexedSurface& surface,
                                                  const TriangleTree& tree,
                                                  const TriangleSurface& given,
                                                  const GroupingOptions& options,
                                                  ExecutionContext& context);

}  // namespace symcell::solid
