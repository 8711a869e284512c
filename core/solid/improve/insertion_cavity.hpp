// The best place for a point that is inserted for the sake of a poor tetrahedron's shape, and the
// tetrahedra that its star replaces.
//
// Where no flip, move or merge helps, as between four vertices of the input that nearly lie in one
// plane, a new vertex does. The cavity starts with the poor tetrahedron and grows across the face
// that makes the worst tetrahedron with the point; after every step the point moves to where the
// worst of its star is best. The mesh is only read (and its stamps written): nothing is done before
// the best of all these stars is known. Source: [KlingnerShewchuk07] sec. 4, with a greedy cavity.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/solid/delaunay/editor.hpp"
#include "core/solid/refine/criteria.hpp"

namespace symcell::solid {

class InsertionCavity {
 public:
  InsertionCavity(Editor& editor, const Criteria& criteria)
      : editor_(editor), mesh_(editor.mesh()), criteria_(criteria) {}

  // True if a star was found whose worst shape is above `wanted`: best() is its cavity, with the
  // point in place. Broken bounds count as poor shapes; whether they are kept is the caller's to
  // look at.
  [[nodiscard]] bool search(TetId t, double wanted);
  [[nodiscard]] const Cavity& best() const { return best_; }

 private:
  [[nodiscard]] double worth(Point3 p, const CavityFace& f, double least) const;
  [[nodiscard]] double star_worth(Point3 p, double least);
  double place_point(std::span<const double> steps, double reach);
  [[nodiscard]] Point3 centroid() const;
  [[nodiscard]] bool holds(TetCopy c) const;
  [[nodiscard]] bool may_cross(std::size_t face) const;
  [[nodiscard]] std::size_t worst_crossable() const;
  [[nodiscard]] bool grow_across(std::size_t face);
  void add(TetCopy c, std::uint32_t entered);
  void drop_face(std::size_t face);
  [[nodiscard]] bool loses_nothing() const;

  Editor& editor_;
  QuotientTetrahedralization& mesh_;
  const Criteria& criteria_;
  Cavity now_, best_;
  std::vector<std::uint32_t> sides_;  // of now_.faces: which face of its owner each is
  std::uint32_t epoch_ = 0;
};

}  // namespace symcell::solid
