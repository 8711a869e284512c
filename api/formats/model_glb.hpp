// A model as it came, as binary glTF: the surface of a solid, the lines of a drawing.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "api/sink.hpp"
#include "core/base/error.hpp"
#include "core/model/model.hpp"

namespace symcell {

// Groups are materials, "boundary_3" or the drawing's names; what is `at_fault` (facets of a PLC, faces of a
// surface, segments of a PSLG, as errors number them; others are passed over) is the material "at fault",
// red. `extras` go into the scene. Indices that the model lacks are passed over: it need not be sound.
// Errors: kDegenerateGeometry (nothing to show), kTooLarge (4 GiB), kWriteFailed.
// Cost: O(n log n) for n corners.
[[nodiscard]] Result<void> write_model_glb(const Model& model,
                                           std::span<const std::int64_t> at_fault,
                                           nlohmann::ordered_json extras,
                                           const Sink& sink);

}  // namespace symcell
