// Which copy of each tetrahedron stands in the cell, with exponents in Z instead of Z/n.
//
// The quotient knows exponents modulo n only. Along a face between two tetrahedra the angle about
// the axis changes by a definite amount (both avoid the axis but for their boundary, so the way
// from centroid to centroid through the face is known without doubt), which lifts the relative
// exponent of the two to an integer. Round a loop that does not wind about the axis these integers
// add up to 0.
//
//   exponent(t): t stands in the cell at this exponent, any integer;
//   jump(h), h a half-face of t: behind the face of t as it stands there is the neighbour's copy in
//   sector jump(h) of the full mesh, relative to the copy in the cell. 0: the face is inside the
//   cell; +1: on the higher bound; -1: on the lower bound; others: the face is on no bound of a
//   usable cell. jump(mate of h) = -jump(h). Modulo n the exponents alone give it; the integer
//   distinguishes lower from higher for n = 2.
#pragma once

#include <cstdint>
#include <vector>

#include "core/solid/quotient/quotient_tetrahedralization.hpp"

namespace symcell::solid {

class Representatives {
 public:
  // Starts with every tetrahedron in the sector between the half-planes at `share` (0 to 1) and
  // 1 + share of 360/n degrees about the axis, by its centroid. Keeps a reference to the mesh.
  // Cost: O(tetrahedra).
  explicit Representatives(const QuotientTetrahedralization& mesh, double share = 0);

  // The share of the half-plane that the fewest faces cross, out of `kShares`.
  static constexpr std::int32_t kShares = 256;
  [[nodiscard]] static double best_share(const QuotientTetrahedralization& mesh);

  [[nodiscard]] const QuotientTetrahedralization& mesh() const { return *mesh_; }
  [[nodiscard]] std::int32_t exponent(TetId t) const { return exponent_[t]; }
  [[nodiscard]] std::int32_t jump(HalfFace h) const { return jump_[h]; }
  // The face lies inside the cell: jump 0 modulo n.
  [[nodiscard]] bool is_inside(HalfFace h) const { return jump_[h] % mesh_->fold() == 0; }
  [[nodiscard]] bool is_self_glued(HalfFace h) const {
    return tet_of(mesh_->tet(tet_of(h)).nb[face_of(h)]) == tet_of(h);
  }

  // Rotates the copy in the cell by `by` sectors.
  void move(TetId t, std::int32_t by);

  // Faces of the quotient with a jump, each once.
  [[nodiscard]] std::uint64_t symmetry_faces() const;

 private:
  const QuotientTetrahedralization* mesh_;
  std::vector<std::int32_t> exponent_;  // per tetrahedron slot
  std::vector<std::int32_t> jump_;      // per half-face; 0 on the hull
};

}  // namespace symcell::solid
