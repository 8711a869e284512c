// FEMM's problem files (.fem, .fee, .feh, .fec) as planar models.
#pragma once

#include <string_view>

#include "core/base/error.hpp"
#include "core/model/pslg.hpp"

namespace symcell {

[[nodiscard]] bool looks_like_fem(std::string_view bytes);

// Points, segments, arcs with the largest angle of their chords, holes and block labels. Markers are
// the numbers of boundary properties, with their names. A label gives its region the area of a
// circle as wide as its mesh size; the attribute is its group, or the number of its material where
// no label of the file has a group. Points that nothing uses are kept.
// What belongs to the physics (materials, circuits, point properties) is not looked at.
// Errors: kSyntax, kTruncated, kCountMismatch, kNonFinite, kIndexOutOfRange, kTooLarge; all name the
// line and the entity.
[[nodiscard]] Result<Pslg> read_fem(std::string_view bytes);

}  // namespace symcell
