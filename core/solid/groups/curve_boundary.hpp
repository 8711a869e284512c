// The boundary of a finished cell on the faces that it was tessellated from.
//
// The mesh follows its surface within the symmetry tolerance. Where a group is a plane, cylinder, cone,
// sphere or torus, vertices are moved onto it, those between groups onto all of them, and mid-side nodes
// of order 2 lie on it. Bounds still match exactly: what is moved are orbits. No element is folded or
// made much worse, and no bound on edges and volumes broken: what would is left as it was, and counted.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/quadratic.hpp"
#include "core/cell/statistics.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/geometry/rotation.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/groups/face_groups.hpp"
#include "core/solid/sizes/size_field.hpp"

namespace symcell::solid {

struct CurvingBounds {
  double farthest = 0;  // that a vertex may be moved, input units
  double radius_edge = kInfinity;
  double max_edge = kInfinity;
  double max_volume = kInfinity;
  const SizeField* sizes = nullptr;
  bool exact = false;  // faces are known, not fitted
};

class CurvedBoundary {
 public:
  // `groups`: with the fits of their pieces.  `tree`: of their surface, in the cell's local frame.
  // `cell`: of order 1, with their markers.
  CurvedBoundary(const FaceGroups& groups,
                 const TriangleTree& tree,
                 const SymmetryCellMesh& cell,
                 const CurvingBounds& bounds);

  // Groups of the cell by whether their shape is known.
  void count_faces(const SymmetryCellMesh& cell, Curving& counts) const;
  [[nodiscard]] bool is_exact() const { return bounds_.exact; }

  // Moves vertices of the cell.  Errors: limits.
  [[nodiscard]] Result<void> move_vertices(SymmetryCellMesh& cell,
                                           Curving& counts,
                                           ExecutionContext& context) const;

  // The cell with mid-side nodes, those of the boundary on the faces.
  // Errors: kInternal, limits.
  [[nodiscard]] Result<SymmetryCellMesh> elevate(const SymmetryCellMesh& cell,
                                                 Curving& counts,
                                                 ExecutionContext& context) const;

 private:
  // A surface as a copy of an orbit's vertex sees it.
  struct Constraint {
    std::int32_t piece = 0;
    std::int32_t exponent = 0;  // of the copy
    friend auto operator<=>(const Constraint&, const Constraint&) = default;
  };
  struct Projected {
    Point3 place;
    bool valid = false;
  };

  [[nodiscard]] std::int32_t piece_of_facet(const SymmetryCellMesh& cell, std::size_t facet) const;
  [[nodiscard]] Point3 onto(const Constraint& c, Point3 p) const;
  [[nodiscard]] Projected project(const std::vector<Constraint>& constraints, Point3 p) const;
  void add(std::vector<Constraint>& constraints, Constraint c, Point3 p) const;
  [[nodiscard]] Point3 normal(const Constraint& c, Point3 p) const;
  [[nodiscard]] bool is_curved(const std::vector<Constraint>& constraints) const;

  const FaceGroups& groups_;
  const TriangleTree& tree_;
  CurvingBounds bounds_;
  RotationTable rotations_;
  std::vector<std::int32_t> piece_;  // per boundary facet of the cell; -1: of no known kind
};

}  // namespace symcell::solid
