// Checks of exact sectors: the invariants of sector.hpp, and measures of the whole surface
// restored from one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/point.hpp"
#include "core/solid/sector/sector.hpp"

namespace symcell::test {

// The whole surface: every face of the sector at all n exponents.
struct RestoredSurface {
  std::vector<Point3> points;  // local frame
  std::vector<std::array<std::int32_t, 3>> faces;
  std::vector<std::int32_t> facet;  // per face
  bool closed = true;               // every edge in an even number of faces
  double volume = 0;               // enclosed; 0 if an edge is in more than two faces or not closed
  std::vector<double> facet_area;  // per facet orbit, all copies
  double segment_length = 0;       // of all copies of all edges
};

[[nodiscard]] RestoredSurface restore_surface(const solid::Sector& sector);

// gtest expectations on the invariants of the contract.
void expect_sound_sector(const solid::Sector& sector);

}  // namespace symcell::test
