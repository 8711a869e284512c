// One exact sector cut from a symmetric PLC.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/sector/sector.hpp"
#include "core/solid/symmetry/symmetric_plc.hpp"

namespace symcell::solid {

// Angles of half-planes that keep away from all vertices but those on the axis, best first: in the
// largest gaps between the vertices' angles modulo 360/n.  One angle for n = 1.
[[nodiscard]] std::vector<double> cut_angles(const SymmetricPlc& plc);

// The sector from `start_angle` (one of cut_angles).  Errors: kInternal where rounding makes the
// pieces of a facet cross (another angle may do); limits.
// Cost: O(m log m) for the m edges of all facets and their crossings with the n half-planes.
[[nodiscard]] Result<Sector> cut_sector(const SymmetricPlc& plc,
                                        double start_angle,
                                        ExecutionContext& context);

}  // namespace symcell::solid
