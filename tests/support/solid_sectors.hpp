// Exact sectors of solids built by rule, for tests of what comes after the symmetry search.
#pragma once

#include <cstdint>
#include <vector>

#include "core/solid/sector/sector.hpp"

namespace symcell::test {

// A prism round the z axis with `fold * corners` corners, one over the middle of each corner's
// share of a sector; the cut crosses its sides between two corners. fold 1: the whole prism, uncut.
struct PrismSpec {
  std::int32_t fold = 6;
  std::int32_t corners = 1;          // of a sector; fold * corners >= 3
  double outer_radius = 1;           // of the corners
  double inner_radius = 0;           // of a bore with as many corners; 0: the axis is inside
  std::vector<double> levels{0, 1};  // ascending z; those between are internal facets
  double start_angle = 0;
  bool inward = false;  // faces turned round: the wall of a cavity
  // Levels only, no walls: facets that dangle. Then `levels` may have one entry.
  bool discs_only = false;
};

// Facets: levels bottom up, then outer walls by layer and corner, then inner ones; facet f has
// marker f + 1, segment s marker s + 1. expected_volume is that of all layers.
[[nodiscard]] solid::Sector prism_sector(const PrismSpec& spec);

// A block that does not touch the cuts: a tetrahedron in the middle of each sector.
[[nodiscard]] solid::Sector block_sector(std::int32_t fold,
                                         double radius,
                                         double size,
                                         double start_angle = 0);

// Both in one; markers of facets and segments of the second follow those of the first. The volumes
// add up, or subtract if the second is a cavity.
[[nodiscard]] solid::Sector joined(solid::Sector first,
                                   const solid::Sector& second,
                                   bool cavity = false);

}  // namespace symcell::test
