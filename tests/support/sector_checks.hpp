// Checks of an exact sector by restoring the whole surface from it.
#pragma once

#include <string>
#include <vector>

#include "core/model/triangle_surface.hpp"
#include "core/solid/sector/sector_source.hpp"

namespace symcell {

struct SectorFigures {
  double volume = 0;       // of all copies
  double off_surface = 0;  // largest distance of vertices and centroids from the input, input units
  double uncovered = 0;    // largest distance of the input's vertices and centroids from all copies
};

// What is wrong with the sector as such, a sentence each; empty: nothing.
[[nodiscard]] std::vector<std::string> sector_faults(const solid::Sector& sector);

[[nodiscard]] SectorFigures measure_sector(const solid::Sector& sector,
                                           const solid::Symmetry& symmetry,
                                           const TriangleSurface& input);

}  // namespace symcell
