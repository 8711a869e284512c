// The laws that every mesh of a random symmetric PLC keeps, found from the model, the options and
// the restored full mesh alone: nothing of the quotient is looked at.
//
//   cell       elements exactly positive; lower_to_higher takes each node to its image
//   full mesh  a face has at most two elements, from opposite sides; no coincident nodes; the
//              model's volume
//   model      vertices are nodes, segments chains of edges; faces at the mesh's rim are given as
//              boundary; boundary faces lie on facets of their marker and fill each; every region
//              has its volume
//   quality    radius-edge ratio but for exempt elements; volume and edge bounds for all
//   figures    statistics say what the mesh is
//   links      and rim, topology, hanging: link_laws.hpp
#pragma once

#include <string>
#include <vector>

#include "core/plane/mesh_pslg.hpp"
#include "tests/support/random_plc.hpp"

namespace symcell {

// One line for each law that does not hold, with the first entity at fault.
// `outcome`: of order 1.
[[nodiscard]] std::vector<std::string> broken_solid_laws(const test::RandomPlc& model,
                                                         const MeshOptions& options,
                                                         const MeshOutcome& outcome);

}  // namespace symcell
