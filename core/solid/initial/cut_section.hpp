// The section of a solid with the half-plane of a sector's lower cut, as triangles over the
// vertices of the cut. Internal to initial/.
//
// Everything in the half-plane that is not reached from infinity without crossing a curve of the
// cut or the axis between two of its vertices. So voids and pockets may be part of it: both sides
// of such a face become void once the quotient is flooded, and the face goes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/solid/sector/sector.hpp"

namespace symcell::solid::initial {

struct CutSection {
  // Sector vertices on the lower cut, counter-clockwise in (distance from the axis, z): seen from
  // the sector's outside.
  std::vector<std::array<std::int32_t, 3>> faces;
  // Per sector vertex on the lower cut: its image on the higher one (axis vertices: themselves);
  // -1 for all others.
  std::vector<std::int32_t> image;
};

// Empty for n = 1 and for sectors that do not touch each other.
// Errors: kTetrahedralizationFailed (curves of the cut cross or overlap: another cut is wanted).
// Cost: O(v log v) for v vertices on the cut.
[[nodiscard]] Result<CutSection> make_cut_section(const Sector& sector);

}  // namespace symcell::solid::initial
