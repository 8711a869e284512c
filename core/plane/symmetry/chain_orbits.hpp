// Which chain of a nearly symmetric shape is the image of which, found from where its junctions
// lie and how it runs; its vertices need not be images of each other.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/plane/symmetry/chains.hpp"

namespace symcell::plane {

struct ChainCopy {
  std::int32_t chain = 0;
  bool reversed = false;
};

struct ChainOrbits {
  // Per orbit of junctions and of lone vertices: the points, copy k at rotation^k of copy 0.
  std::vector<std::vector<std::int32_t>> points;
  // Per orbit of chains likewise; a loop round the centre is its own image and stands alone.
  std::vector<std::vector<ChainCopy>> chains;
};

// `index`: of the prepared edges.  `reach`: how far an image may be off, input units.
// Errors: kNotSymmetric (names what has no image).  Cost: O(N log N).
[[nodiscard]] Result<ChainOrbits> find_chain_orbits(const PreparedPslg& prepared,
                                                    const SegmentIndex& index,
                                                    const Chains& chains,
                                                    std::int32_t fold,
                                                    Point2 centre,
                                                    std::int32_t centre_point,
                                                    double reach);

}  // namespace symcell::plane
