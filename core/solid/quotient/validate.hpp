// Layered checks of a quotient mesh of tetrahedra, each resting on the ones below; a failure names
// its layer. The layers for solids:
//   kElements    corners and exponents in range, positive orientation: exact on one sheet, certain
//                elsewhere (core/solid/quotient/lifted_predicates.hpp);
//   kIncidence   the invariants of quotient_tetrahedralization.hpp; regions differ across facets
//                only; vertex kinds agree with the segments and facets at a vertex;
//   kEmbedding   dihedral angles round every edge make one turn inside, less on the hull, one n-th
//                of a turn on the axis; the volume is the one expected;
//   kDelaunay    counts only: improvement may trade the Delaunay property for quality.
#pragma once

#include <cstdint>

#include "core/base/error.hpp"
#include "core/base/validation_level.hpp"
#include "core/solid/quotient/quotient_tetrahedralization.hpp"

namespace symcell::solid {

struct TetrahedraReport {
  double volume = 0;                // of the quotient mesh: full volume / n; from kIncidence on
  std::uint64_t free_faces = 0;     // inner faces that are no facets; of kDelaunay
  std::uint64_t certain_flips = 0;  // those of them that are certainly not locally Delaunay
};

// `expected_volume`: of the quotient mesh, 0 if unknown; looked at from kEmbedding on.
// Errors: kInternal with the layer, the tetrahedron and the corner, face or edge.
// Cost: O(tetrahedra).
[[nodiscard]] Result<TetrahedraReport> validate(const QuotientTetrahedralization& mesh,
                                                ValidationLevel level,
                                                double expected_volume = 0);

}  // namespace symcell::solid
