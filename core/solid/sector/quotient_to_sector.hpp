// A quotient surface written as an exact sector: facets, segments and kinds of vertices.
#pragma once

#include "core/base/error.hpp"
#include "core/solid/sector/sector.hpp"
#include "core/solid/surface/quotient_surface.hpp"

namespace symcell::solid {

// Requires: planar patches were found. Facets are the edge-connected parts of the patches; every
// other triangle is a facet of its own.  Errors: kInternal (not closed).
[[nodiscard]] Result<Sector> quotient_to_sector(const QuotientSurface& surface);

}  // namespace symcell::solid
