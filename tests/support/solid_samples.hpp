// Small quotient meshes of tetrahedra made by hand, without the mesher: prisms round the axis and
// rings, cut into columns of tetrahedra; and the models they mesh.
#pragma once

#include <cstdint>

#include "core/model/plc.hpp"
#include "core/solid/initial/initial_tetrahedralization.hpp"

namespace symcell::test {

struct PrismShape {
  std::int32_t fold = 6;
  std::int32_t steps = 1;   // edges of the outer polygon a sector; fold * steps >= 3
  std::int32_t rings = 1;   // from the axis or the inner polygon to the outer one
  std::int32_t layers = 1;  // along the axis
  double inner_radius = 0;  // 0: the axis lies inside
  double outer_radius = 2;
  double height = 1;
  // Radians by which the vertices half way are turned against those of the surface.
  double swirl = 0;
  bool inner_facet = false;  // a plate at half height (layers even): internal facet, two regions
};

// A prism over a regular polygon, or a ring between two. Vertex kinds, facets (0: bottom, 1: top,
// then one an outer and an inner side face, at last the plate), segments and subdomains are as the
// initial tetrahedralization gives them; facet f has marker f + 1.
[[nodiscard]] solid::InitialTetrahedralization prism(const PrismShape& shape);
[[nodiscard]] Plc prism_model(const PrismShape& shape);
[[nodiscard]] double prism_volume(const PrismShape& shape);  // of the full model

// Stores every tetrahedron in a frame drawn at random: the same quotient mesh.
void shuffle_gauge(solid::QuotientTetrahedralization& mesh, std::uint64_t seed);

// Moves free vertices at random by up to `share` of their shortest edge, where that leaves all
// tetrahedra positively oriented.
void jitter(solid::QuotientTetrahedralization& mesh, double share, std::uint64_t seed);

// Random 2-3 and 3-2 flips of inner faces and edges that are no constraints; the number done.
int random_flips(solid::QuotientTetrahedralization& mesh, int tries, std::uint64_t seed);

}  // namespace symcell::test
