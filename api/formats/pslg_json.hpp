// Planar straight line graphs as JSON:
//   {"type": "pslg", "vertices": [[x, y], ...], "segments": [[i, j] | [i, j, marker], ...],
//    "holes": [[x, y], ...], "regions": [{"point": [x, y], "attribute": k, "max_area": a}, ...]}
// "name", "comment" and "units" are allowed and not looked at; any other key is refused, so that a
// misspelt one is not passed over in silence. Events only, no tree: memory is that of the result.
#pragma once

#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/model/pslg.hpp"

namespace symcell {

// Errors, with a JSON pointer and the byte: kJsonSyntax, kJsonTooDeep, kWrongType, kMissingField,
// kTooLarge, kNonFinite, kUnsupportedModel ("plc"), kIndexOutOfRange (an index beyond 32 bits; all
// others are left to validate_pslg).
[[nodiscard]] Result<Pslg> read_pslg_json(std::string_view bytes);

// The inverse: numbers in the shortest form that reads back as the same bits.
[[nodiscard]] std::string write_pslg_json(const Pslg& pslg);

}  // namespace symcell
