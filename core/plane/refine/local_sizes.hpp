// Largest edge lengths where the options ask for them: along segments of a marker and at vertices.
// Given for one vertex they hold at all its copies, as the mesh repeats.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/error.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"
#include "core/plane/quotient/quotient_triangulation.hpp"
#include "core/plane/refine/graded_size.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

struct LocalSizes {
  // Edges that grow away from small ones; null: without a bound.
  std::shared_ptr<const GradedSize> graded;
  std::vector<std::uint8_t> kept_segment;  // per segment orbit: no new vertices; empty: none
  std::vector<double>
      of_segment;  // per segment orbit, in input units, inf: none; empty: none at all
  std::vector<double> at_vertex;  // per vertex orbit, likewise: of every edge at it
};

// Errors: kBadOption: a marker that no segment has, a vertex that is none of the domain, different
// sizes for copies of one vertex.
[[nodiscard]] Result<LocalSizes> resolve_sizes(const Pslg& pslg,
                                               const SymmetricPslg& symmetric,
                                               const std::vector<SizeRequest>& sizes);

// What edges may grow from: the sizes asked for, and the shortest edge at each vertex of the initial
// mesh, so that narrow places count, but no size below `least`.
[[nodiscard]] GradedSize grade_sizes(const QuotientTriangulation& initial,
                                     const LocalSizes& sizes,
                                     double gradation,
                                     double least);

}  // namespace symcell::plane
