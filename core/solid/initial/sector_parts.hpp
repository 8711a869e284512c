// Which tetrahedra of a sector are material, and of which subdomain. Internal to initial/.
//
// A part is what flooding across faces without label reaches, and across the section from the
// higher cut to the lower one. Outside is what reaches the convex hull. Nesting models: material
// are the parts an odd number of facets away from outside. Seeded models: all parts but outside and
// those with a hole seed.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/initial/initial_tetrahedralization.hpp"
#include "core/solid/initial/sector_mesh.hpp"
#include "core/solid/sector/sector.hpp"

namespace symcell::solid::initial {

struct SectorParts {
  std::vector<std::int32_t> subdomain;  // per tetrahedron; -1: no material
  std::vector<Subdomain> subdomains;
};

// Errors: kTetrahedralizationFailed (not closed), kUnreachableSeed, kConflictingSeeds, limits.
[[nodiscard]] Result<SectorParts> find_sector_parts(const Sector& sector,
                                                    const CutSection& section,
                                                    const SectorMesh& mesh,
                                                    ExecutionContext& context);

}  // namespace symcell::solid::initial
