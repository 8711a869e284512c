// Chords that refinement split, with the new vertices on their arcs.
#pragma once

#include <cstddef>
#include <optional>

#include "core/plane/quotient/quotient_triangulation.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

// A PSLG whose chords have a vertex on their arc where `mesh`, which was made of `pslg`, has one on
// the chord; nothing if it has none.  Cost: O(triangles + splits n).
[[nodiscard]] std::optional<SymmetricPslg> split_chords(const SymmetricPslg& pslg,
                                                        const QuotientTriangulation& mesh);

// How many vertices of `mesh` lie on chords, beside their arcs.  Cost: O(triangles).
[[nodiscard]] std::size_t vertices_on_chords(const SymmetricPslg& pslg,
                                             const QuotientTriangulation& mesh);

}  // namespace symcell::plane
