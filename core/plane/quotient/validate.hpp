// Layered checks of a quotient mesh, each resting on the one below; a failure names its layer.
#pragma once

#include "core/base/error.hpp"
#include "core/base/validation_level.hpp"
#include "core/plane/quotient/quotient_triangulation.hpp"

namespace symcell::plane {

// Errors: kInternal with the layer, the triangle and the edge.  Cost: O(triangles).
[[nodiscard]] Result<void> validate(const QuotientTriangulation& mesh, ValidationLevel level);

}  // namespace symcell::plane
