// Region attributes that differ between the copies of a tetrahedron: parts of the full mesh are
// found by flooding the quotient between facets.
//
// A part of the quotient lifts to one or more parts of the full mesh: as many as the greatest
// common divisor of n and the exponents gathered round its loops. Seeds give the attributes of
// those.
#pragma once

#include <cstdint>
#include <vector>

#include "core/solid/quotient/quotient_tetrahedralization.hpp"
#include "core/solid/sector/sector_source.hpp"

namespace symcell::solid {

class SectorRegions {
 public:
  // Where several seeds lie in one part of the full mesh, the first one counts; parts without a
  // seed have attribute 0. Keeps a reference to the mesh.
  // Cost: O(tetrahedra * seeds).
  SectorRegions(const QuotientTetrahedralization& mesh, const std::vector<SectorRegion>& seeds);

  // Whether any two copies of one tetrahedron differ.
  [[nodiscard]] bool differ() const;
  // Attribute of the copy of t at `exponent`, in [0, n).
  [[nodiscard]] std::int32_t attribute(TetId t, std::int32_t exponent) const;

 private:
  struct Part {
    std::int32_t copies = 1;               // parts of the full mesh, a divisor of n
    std::vector<std::int32_t> attributes;  // of each
    std::vector<std::uint8_t> seeded;
  };

  void flood();
  // The copy that contains the point best.
  [[nodiscard]] TetCopy locate(Point3 p) const;
  [[nodiscard]] std::size_t copy_of(TetId t, std::int32_t exponent) const;

  const QuotientTetrahedralization& mesh_;
  std::vector<Part> parts_;
  std::vector<std::int32_t> part_;    // per tetrahedron
  std::vector<std::int32_t> offset_;  // per tetrahedron: exponent relative to its part's first
};

}  // namespace symcell::solid
