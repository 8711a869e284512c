// OFF (Object File Format), text form: vertices and polygons. Normals, colours and texture
// coordinates (NOFF, COFF, STOFF and their combinations) are read over; the keyword may be left
// out.
#pragma once

#include <string_view>

#include "core/base/error.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell {

// Messages name the line.  Errors: kSyntax, kCountMismatch, kTruncated, kTooLarge, kNonFinite,
// kIndexOutOfRange, kDegenerateFacet, kDegenerateGeometry (no faces), kUnsupportedModel (binary or
// four-dimensional).
[[nodiscard]] Result<TriangleSurface> read_off(std::string_view bytes);

// Whether a file's first word is OFF's keyword, in one of its forms.
[[nodiscard]] bool is_off_keyword(std::string_view word);

}  // namespace symcell
