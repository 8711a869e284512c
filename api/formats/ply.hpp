// PLY (Polygon File Format), ASCII and binary of either byte order: the x, y, z of its vertices and
// the vertex lists of its faces; other properties and elements are read over.
#pragma once

#include <string_view>

#include "core/base/error.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell {

// Messages name the line of the header, or the element.  Errors: kSyntax, kTruncated,
// kCountMismatch (more follows than the header says), kMissingField (no x, y, z or no faces),
// kNonFinite, kIndexOutOfRange, kDegenerateFacet, kTooLarge, kDegenerateGeometry (no faces),
// kUnsupportedModel (triangle strips, an unknown format).
[[nodiscard]] Result<TriangleSurface> read_ply(std::string_view bytes);

}  // namespace symcell
