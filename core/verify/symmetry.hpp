// The checks of a cell's symmetry: its pairs, its bounds, and the copies that the full mesh
// consists of. Included by the parts of verify_mesh only.
#pragma once

#include <vector>

#include "core/geometry/axis_frame.hpp"
#include "core/geometry/rotation.hpp"
#include "core/verify/support.hpp"

namespace symcell::internal {

// Rotations about the cell's axis.
class Turns {
 public:
  // Requires: the cell's fields are sound.
  explicit Turns(const MeshData& cell);

  [[nodiscard]] std::int32_t fold() const { return rotations_.fold(); }
  [[nodiscard]] Point3 rotated(const Point3& p, std::int32_t k) const {
    return frame_.to_model(rotations_.rotate(frame_.to_local(p), rotations_.reduce(k)));
  }
  [[nodiscard]] Point3 local(const Point3& p) const { return frame_.to_local(p); }
  [[nodiscard]] double from_axis(const Point3& p) const {
    return length(planar(frame_.to_local(p)));
  }

 private:
  AxisFrame frame_;
  RotationTable rotations_;
};

// Groups of the cell's boundary facets on its bounds; lower[i] goes to higher[i].
struct CellBounds {
  std::vector<std::size_t> lower;
  std::vector<std::size_t> higher;
};

// How far apart two nodes may be that the file pairs, and how near those that it does not pair have
// to be for them to be a pair all the same.
struct PairTolerances {
  double paired = 0;
  double unpaired = 0;  // at most `paired`
};

// cell.pairs, .pairs_injective, .axis_self, .pairs_complete.  False if the full mesh cannot be
// restored.
bool check_pairs(const MeshData& cell,
                 const Turns& turns,
                 const PairTolerances& tolerances,
                 Checks& checks);

// cell.bounds, .bounds_nodes.  Requires: check_pairs passed.
CellBounds check_bounds(const FacetedMesh& cell,
                        const Turns& turns,
                        double tolerance,
                        const ModelPinches& pinches,
                        Checks& checks);

// n copies of the cell, glued by the pairs: (i, k + 1) is (pair of i, k).  Requires: likewise.
[[nodiscard]] MeshData restore(const MeshData& cell, const Turns& turns);

// full.copies, .pairs, .regions.  `every_region`: regions must be the cell's in every sector and
// not only in the first.  False if elements are not copies of the cell's, each once.
bool check_copies(const MeshData& cell,
                  const MeshData& full,
                  const Turns& turns,
                  double tolerance,
                  bool every_region,
                  Checks& checks);

// cell.connected, .bounds_in_full.  Requires: check_copies passed.
void check_cell_in_full(const FacetedMesh& cell,
                        const CellBounds& bounds,
                        const FacetedMesh& full,
                        double tolerance,
                        Checks& checks);

}  // namespace symcell::internal
