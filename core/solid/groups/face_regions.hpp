// Faces of a tessellated surface: triangles that hang together without a sharp edge between them,
// and which faces are copies of each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/triangle_tree.hpp"

namespace symcell::solid {

struct FaceRegions {
  std::int32_t count = 0;
  std::vector<std::int32_t> of_triangle;  // numbers from 0, in the order of the triangles
};

// Whether a triangle is too low, for so much noise of its coordinates, to have a normal to go by.
[[nodiscard]] bool is_thin(const IndexedSurface& surface, const Triangle& triangle, double noise);

// `feature_angle`: radians; an edge at which the surface turns by as much or more lies between two
// faces. `noise`: of the coordinates; thin triangles belong to a neighbour. `names`: per triangle, a
// face has one of them only; empty: all have the same.
// Cost: O(T log T).
[[nodiscard]] FaceRegions find_face_regions(const IndexedSurface& surface,
                                            double feature_angle,
                                            double noise,
                                            std::span<const std::int32_t> names);

// Joins the numbers of faces that a turn by 360/fold degrees about the z axis takes to each other:
// the face that most of one goes to. Copies that are tessellated otherwise, and that the feature
// angle divides otherwise for that, become one number.
// `tree`: of the surface.  `reach`: how far copies may be apart.  Errors: limits.
// Cost: O(T log T).
[[nodiscard]] Result<FaceRegions> join_copies(const IndexedSurface& surface,
                                              const TriangleTree& tree,
                                              FaceRegions regions,
                                              std::int32_t fold,
                                              double reach,
                                              std::span<const std::int32_t> names,
                                              ExecutionContext& context);

}  // namespace symcell::solid
