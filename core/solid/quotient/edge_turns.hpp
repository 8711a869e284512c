// Whether the dihedral angles round every edge make one turn: of the embedding, what
// validate.hpp asks for above positive tetrahedra and faces that agree.
#pragma once

#include <cstdint>
#include <optional>

#include "core/solid/quotient/quotient_tetrahedralization.hpp"

namespace symcell::solid {

struct LocalEdge {
  TetId tet = 0;
  std::uint32_t edge = 0;  // index in kEdgeCorners
};

// The first edge round which the tetrahedra make not one turn inside, less on the hull, one n-th of
// a turn on the axis.
// Requires: layers kElements and kIncidence.  Cost: O(tetrahedra), each seen once an edge.
[[nodiscard]] std::optional<LocalEdge> find_wrong_turn(const QuotientTetrahedralization& mesh);

}  // namespace symcell::solid
