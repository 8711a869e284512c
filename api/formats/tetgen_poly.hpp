// TetGen's `.poly` and `.smesh`: vertices, facets, volume holes and regions in one text file.
//
// Comments (`#` to the end of the line), numbering from 0 or 1 (as the first vertex's number),
// vertex attributes and markers (read over), facet markers, corners of a polygon over several
// lines, regions with attribute and volume (a volume <= 0 is no bound). A `.smesh` has one polygon
// a facet. Vertices in a separate `.node` file are not followed.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "core/model/plc.hpp"

namespace symcell {

enum class TetgenForm : std::uint8_t { kPoly, kSmesh };

// Messages name the line.  Errors: kSyntax, kCountMismatch, kTruncated, kTooLarge, kNonFinite,
// kMissingField (a .node file is needed), kUnsupportedModel (2 dimensions), kIndexOutOfRange (an
// index beyond 32 bits; all others are left to the model's validation).
[[nodiscard]] Result<Plc> read_tetgen(std::string_view bytes, TetgenForm form);

// What the first line of a `.poly` says: 2 or 3; nullopt if it says nothing of the kind.
[[nodiscard]] std::optional<int> poly_dimension(std::string_view bytes);

}  // namespace symcell
