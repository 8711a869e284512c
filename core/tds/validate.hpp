// Layered checks of a quotient mesh, each resting on the one below; a failure names its layer.
#pragma once

#include "core/base/error.hpp"
#include "core/tds/quotient_triangulation.hpp"

namespace symcell {

enum class ValidationLevel : std::uint8_t {
  kElements,   // slots, ids and exponents in range, corners different
  kIncidence,  // neighbours agree: involution, exponents, corners, subsegments
  kEmbedding,  // every triangle positively oriented
  kDelaunay    // every free edge locally Delaunay (within the certainty of lifted predicates)
};

// Errors: kInternal with the layer, the triangle and the edge.  Cost: O(triangles).
[[nodiscard]] Result<void> validate(const QuotientTriangulation& mesh, ValidationLevel level);

}  // namespace symcell
