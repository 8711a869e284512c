// The whole model of which a PSLG is one of n equal sectors.
#pragma once

#include <cstdint>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"

namespace symcell::plane {

// The sector and its copies, turned about the centre. Lines and arcs that the copies of neighbours
// share, whole or in part, are the sector's two bounds: they are matched, and where the regions on
// both sides are alike they are taken out, with their markers. Seeds are copied, too, and
// what the copies enclose together without holding it, as the bore of a ring, gets a hole seed.
// `tolerance`: distance by which the bounds may differ.
// Requires: check_entities(pslg) passed.
// Errors: kBadFold (fewer than 2 sectors), kNotSymmetric (the bounds do not meet, or all but meet;
// names a place),
// kTooLarge, and those of validate_pslg where sectors overlap.
// `options`: of the chords of arcs, for what lies on their two sides.  Cost: O(nN log nN).
[[nodiscard]] Result<Pslg> make_whole(const Pslg& pslg,
                                      std::int32_t sectors,
                                      Point2 centre,
                                      double tolerance,
                                      const MeshOptions& options,
                                      ExecutionContext& context);

}  // namespace symcell::plane
