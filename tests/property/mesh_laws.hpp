// The laws that every mesh of a valid symmetric model keeps, found from the model, the options and
// the restored full mesh alone: nothing of the quotient is looked at.
//
//   cell       elements exactly positive; lower_to_higher takes each node to its image
//   full mesh  conforming, no coincident nodes, area of the model, boundary on the model's boundary
//   model      vertices are nodes, segments are chains of edges, holes empty, attributes as seeded
//   quality    locally Delaunay but at segments; angles, areas and edges within their bounds;
//              exempt are only elements at narrow input corners, across them, or at the centre
//   figures    statistics say what the mesh is
//   links      and rim, topology, hanging: planar_link_laws.hpp
#pragma once

#include <string>
#include <vector>

#include "core/plane/mesh_pslg.hpp"

namespace symcell {

// One line for each law that does not hold, with the first entity at fault.
// `area`: of the meshed domain, known by construction.  `outcome`: of order 1.  `pinches`: where
// the domain touches itself in a vertex.
[[nodiscard]] std::vector<std::string> broken_laws(const Pslg& model,
                                                   double area,
                                                   const MeshOptions& options,
                                                   const MeshOutcome& outcome,
                                                   const std::vector<Point2>& pinches = {});

}  // namespace symcell
