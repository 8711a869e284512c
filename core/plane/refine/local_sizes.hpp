// Largest edge lengths where the options ask for them: along segments of a marker and at vertices.
// Given for one vertex they hold at all its copies, as the mesh repeats.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

struct LocalSizes {
  std::vector<double>
      of_segment;  // per segment orbit, in input units, inf: none; empty: none at all
  std::vector<double> at_vertex;  // per vertex orbit, likewise: of every edge at it
};

// Errors: kBadOption: a marker that no segment has, a vertex that is none of the domain, different
// sizes for copies of one vertex.
[[nodiscard]] Result<LocalSizes> resolve_sizes(const Pslg& pslg,
                                               const SymmetricPslg& symmetric,
                                               const std::vector<SizeRequest>& sizes);

}  // namespace symcell::plane
