// Wavefront OBJ: `v` and `f` lines (corners as v, v/vt, v//vn, v/vt/vn; negative ones count back
// from the last vertex so far). Everything else - normals, groups, materials, lines - is read over.
#pragma once

#include <string_view>

#include "core/base/error.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell {

// Messages name the line.  Errors: kSyntax, kNonFinite, kIndexOutOfRange, kDegenerateFacet,
// kTooLarge, kDegenerateGeometry (no faces).
[[nodiscard]] Result<TriangleSurface> read_obj(std::string_view bytes);

}  // namespace symcell
