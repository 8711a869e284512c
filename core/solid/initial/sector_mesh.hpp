// The tetrahedralization of a sector with all faces of its boundary, its internal facets and the
// section on both cuts. Internal to initial/.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/initial/cut_section.hpp"
#include "core/solid/quotient/quotient_tetrahedralization.hpp"
#include "core/solid/sector/sector.hpp"

namespace symcell::solid::initial {

inline constexpr std::int32_t kNoLabel = -1;  // a face inside

// Covers the sector's convex hull. Corner and face numbering as in QuotientTetrahedralization.
struct SectorMesh {
  std::vector<Point3> points;  // of the sector's vertices, then of those added inside
  std::vector<std::array<std::int32_t, 4>> tets;
  std::vector<std::array<HalfFace, 4>> nb;  // kNoHalfFace on the hull
  // What face i of a tetrahedron lies on: a face of the sector, of the section on the lower cut
  // (after all of the sector), on the higher cut (after those), or kNoLabel.
  std::vector<std::array<std::int32_t, 4>> label;
  std::int32_t sector_faces = 0;
  std::int32_t section_faces = 0;

  [[nodiscard]] bool on_sector_face(std::int32_t l) const { return l >= 0 && l < sector_faces; }
  // Index of the section face, -1 if it is none.
  [[nodiscard]] std::int32_t lower_section_face(std::int32_t l) const {
    return l >= sector_faces && l < sector_faces + section_faces ? l - sector_faces : -1;
  }
  [[nodiscard]] std::int32_t higher_section_face(std::int32_t l) const {
    return l >= sector_faces + section_faces ? l - sector_faces - section_faces : -1;
  }
};

// Every face of sector and section is a face of the result, every edge of the sector an edge.
// Errors: kTetrahedralizationFailed, kInternal, limits.
[[nodiscard]] Result<SectorMesh> make_sector_mesh(const Sector& sector,
                                                  const CutSection& section,
                                                  ExecutionContext& context);

}  // namespace symcell::solid::initial
