// Wedge and glue: from one exact sector to the quotient of a constrained tetrahedralization.
//
// 1. The section S of the solid with the half-plane of the lower cut: constrained Delaunay
//    triangulation of the cut's curves and of the pieces of the axis in the material.
// 2. The wedge bounded by the sector's faces, S and its image R S is tetrahedralized with its
//    boundary kept (TetGen), in another process.
// 3. S is glued to R S through the index map: S is no constraint any longer, edges on the axis and
//    on segments of the input are.
// 4. Outside, holes and voids are removed by flooding the quotient; regions are named by seeds.
// Source: [paper] sec. 5.1 (FindSymmetryBounds).
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/guard/facet_cover.hpp"
#include "core/solid/quotient/quotient_tetrahedralization.hpp"
#include "core/solid/sector/sector.hpp"
#include "core/solid/sizes/size_field.hpp"

namespace symcell::solid {

struct Subdomain {
  std::int32_t attribute = 0;
  double max_volume = std::numeric_limits<double>::infinity();
};

struct InitialTetrahedralization {
  QuotientTetrahedralization mesh{1};
  std::vector<Subdomain> subdomains;          // Tet::region is an index of these
  std::vector<std::int32_t> facet_markers;    // Tet::facet is an index of these
  std::vector<std::int32_t> segment_markers;  // of the ids in mesh.edges(); the axis has its own, 0
  // The facets are a tessellation of some shape: angles within and between them that come of
  // tessellating exempt from nothing; only sharp edges of the shape do.
  bool tessellated = false;
  // With ignore_markers: regions of the copies, by seeds; see cut/build_cell_mesh.
  std::vector<SectorRegion> seeds;
  bool regions_differ = false;
  // What every mesh made from this one has to cover; see guard/facet_cover.hpp.
  FacetCover cover;
  double diameter = 0;  // of the model, about
  // How long edges may be from place to place; null: no bounds but those for all.
  std::shared_ptr<const SizeField> sizes;
  // Of edges in mesh.edges() that lie on the axis and on no segment.
  [[nodiscard]] std::int32_t axis_segment() const {
    return static_cast<std::int32_t>(segment_markers.size()) - 1;
  }
};

// Vertices: sector orbit i is vertex i; kInput, kSegment or kFacet by its kind in the sector, those
// of the interior that the tetrahedralization added are kFree. kOnSegment vertices on the axis:
// kSegment. Errors: kTetrahedralizationFailed (the sector is not usable: try another),
// kUnreachableSeed, kConflictingSeeds, kInternal, limits.
[[nodiscard]] Result<InitialTetrahedralization> tetrahedralize_sector(const Sector& sector,
                                                                      ExecutionContext& context);

}  // namespace symcell::solid
