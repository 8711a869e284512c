// Layers of checks of a quotient mesh.
#pragma once

#include <cstdint>

namespace symcell {

enum class ValidationLevel : std::uint8_t {
  kElements,   // slots, ids and exponents in range, corners different
  kIncidence,  // neighbours agree: involution, exponents, corners, constraints
  kEmbedding,  // the elements cover the domain once: see the wings' validate.hpp
  kDelaunay    // every free edge locally Delaunay (within the certainty of lifted predicates)
};

}  // namespace symcell
