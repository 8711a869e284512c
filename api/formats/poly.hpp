// Triangle's `.poly`: vertices, segments, holes and regions in one text file.
//
// Comments (`#` to the end of the line), numbering from 0 or 1 (as the first vertex's number),
// vertex attributes and markers (read over), segment markers, regions with attribute and area (an
// area <= 0 is no bound). Vertices in a separate `.node` file are not followed.
#pragma once

#include <string_view>

#include "core/base/error.hpp"
#include "core/model/pslg.hpp"

namespace symcell {

// Messages name the line.  Errors: kSyntax, kCountMismatch, kTruncated, kTooLarge, kNonFinite,
// kMissingField (a .node file is needed), kUnsupportedModel (3 dimensions), kIndexOutOfRange (an
// index beyond 32 bits; all others are left to validate_pslg).
[[nodiscard]] Result<Pslg> read_poly(std::string_view bytes);

}  // namespace symcell
