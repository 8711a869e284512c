// Piecewise linear complexes as JSON:
//   {"type": "plc", "vertices": [[x, y, z], ...],
//    "facets": [{"polygons": [[i, j, k, ...], ...], "holes": [[x, y, z], ...], "marker": m}, ...],
//    "segments": [[i, j] | [i, j, marker], ...], "holes": [[x, y, z], ...],
//    "regions": [{"point": [x, y, z], "attribute": k, "max_volume": v}, ...]}
// A facet's "holes" and "marker" and the lists from "segments" on may be left out. "name",
// "comment" and "units" are allowed and not looked at; any other key is refused.
#pragma once

#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/model/model.hpp"

namespace symcell {

// Errors, with a JSON pointer and the byte: kJsonSyntax, kJsonTooDeep, kWrongType, kMissingField,
// kTooLarge, kNonFinite, kIndexOutOfRange (an index beyond 32 bits; all others, and the facets'
// shapes, are left to the model's validation).
[[nodiscard]] Result<Plc> read_plc_json(std::string_view bytes);

// The inverse: numbers in the shortest form that reads back as the same bits.
[[nodiscard]] std::string write_plc_json(const Plc& plc);

// Which kind of model a JSON text says it holds: by "type", or by "facets" where that comes first.
// A text that does not say, or is none, is taken for planar.
[[nodiscard]] ModelKind json_model_kind(std::string_view bytes);

}  // namespace symcell
