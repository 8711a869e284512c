// What is done to a planar model before it is taken as a whole: loose ends that meet but for
// rounding are joined, on request all that overlaps is mended, and a sector gets its copies.
#pragma once

#include <optional>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/warning.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"

namespace symcell::plane {

struct PlanarInput {
  Pslg pslg;
  MeshOptions options;  // with the fold and the centre of a sector
};

// Nothing if the model is taken as it is.
//
// Ends of one segment alone that stand within 1e-6 of the diameter of another vertex become that
// vertex, unless `repair` is kNone. With kAll other vertices that are as near to each other do, too,
// segments that cross are split there, and segments that lie on others, in whole or in part, are one.
// `notes` of the result tell what was done. With `sector` the fold is that number, unless
// `ignore_markers` asks for the fold of the shape alone.
// Errors: kBadFold, kBadAxis, kNotSymmetric (of a sector); those of check_entities; limits.
[[nodiscard]] Result<std::optional<PlanarInput>> prepare_input(const Pslg& pslg,
                                                               const MeshOptions& options,
                                                               ExecutionContext& context);

// What `notes` say.
[[nodiscard]] std::vector<Warning> warnings_of(const PslgNotes& notes);

}  // namespace symcell::plane
