// What the readers of surfaces with shared vertices have in common.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/error.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell::internal {

// Appends the polygon `face` (from 0) of a file; corners are vertex indices from 0. `place` begins
// messages ("line 12: ").
// Errors: kDegenerateFacet (fewer than three corners, or one twice), kIndexOutOfRange, kTooLarge.
[[nodiscard]] Result<void> append_face(std::span<const std::int64_t> corners,
                                       std::size_t face,
                                       const std::string& place,
                                       TriangleSurface& surface);

// The surface, once it is complete.  Errors: kDegenerateGeometry if it has no triangles.
[[nodiscard]] Result<TriangleSurface> finished(TriangleSurface surface, const char* format);

}  // namespace symcell::internal
