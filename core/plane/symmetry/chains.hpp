// A prepared PSLG as chains of edges between junctions: what symmetry sees of a shape whose sectors
// have vertices in different places.
//
// A junction is a vertex where other than two edges meet, or two that differ in marker or in the
// classes beside them; the centre is one, too. All other vertices only say where a chain runs.
#pragma once

#include <vector>

#include "core/plane/symmetry/prepared_pslg.hpp"

namespace symcell::plane {

struct Chain {
  std::vector<std::int32_t> points;  // of the PSLG, in order; of a loop the first is not repeated
  PreparedEdge kind;  // marker, classes and labels in that direction, the first edge's segment
  bool loop = false;  // no junction on it; runs counterclockwise

  // The two junctions, or -1.
  [[nodiscard]] std::int32_t first() const { return loop ? -1 : points.front(); }
  [[nodiscard]] std::int32_t last() const { return loop ? -1 : points.back(); }
};

struct Chains {
  std::vector<Chain> chains;
  std::vector<std::int32_t> degree;     // per point
  std::vector<std::int32_t> junctions;  // points, ascending
  std::vector<std::int32_t> lone;       // points without an edge, ascending
  bool mixed_markers = false;           // a chain has several markers, which are ignored
};

// `centre`: the point that is a junction whatever meets there, -1: none.  Cost: O(N).
[[nodiscard]] Chains make_chains(const PreparedPslg& prepared, std::int32_t centre);

}  // namespace symcell::plane
