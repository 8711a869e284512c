// The subfacets and subsegments of a quotient mesh as plain lists, for the checks that know nothing
// of it.
#pragma once

#include <cstdint>

#include "core/guard/facet_cover.hpp"
#include "core/solid/quotient/quotient_tetrahedralization.hpp"

namespace symcell::solid {

// `axis_segment`: the id of edges on the axis that no segment of the model holds; they are left
// out. Points and `on_axis` are by vertex id.
[[nodiscard]] Constraints constraints_of(const QuotientTetrahedralization& mesh,
                                         std::int32_t axis_segment);

}  // namespace symcell::solid
