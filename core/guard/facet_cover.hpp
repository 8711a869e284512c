// What the subfacets and subsegments of a mesh cover of the facets and segments that it was made
// from: the guard against subfacets that lie across a gap, outside, or twice.
//
// The same is measured on the faces and edges of the exact sector that a mesh starts from and on
// the finished mesh, and compared:
//   length of the subsegments on each segment;
//   area of the subfacets on each facet, apart for those with the solid on one side and on both;
//   subfacets of a facet that meet at an edge: as many as at its segments, elsewhere two, on
//   different sides of the edge and in one plane;
//   shells, Euler characteristic and pinches of the boundary.
// Subfacets that hang together without folds, end at all of a facet's outline and nowhere else, and
// have its area, fill it once. If then all tetrahedra are positive and a face has two of them but
// on such subfacets, the mesh fills the solid once: no crack is left in which a node could hang, no
// vertex or edge inside has a link in pieces. Shares no code with the meshers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/point.hpp"
#include "core/guard/boundary_topology.hpp"

namespace symcell {

struct Subfacet {
  OrbitTriangle corners;
  std::int32_t facet = 0;
  bool two_sided = false;  // the solid is on both sides
};

struct Subsegment3 {
  OrbitVertex a, b;
  std::int32_t segment = 0;
};

// The subfacets and subsegments of a sector or mesh, one an orbit.
struct Constraints {
  std::int32_t fold = 1;
  std::vector<Point3> points;         // per orbit, in the frame of the axis
  std::vector<std::uint8_t> on_axis;  // likewise
  std::vector<Subfacet> subfacets;
  std::vector<Subsegment3> subsegments;
};

struct FacetCover {
  struct Facet {
    double one_sided_area = 0;
    double two_sided_area = 0;
    double outline = 0;  // length of edges with one subfacet of the facet
    // By what the corners of two subfacets that adjoin must move to lie in one plane, at most.
    double bend = 0;
  };
  // Subfacets of one facet at a subsegment.
  struct Incidence {
    std::int32_t segment = 0;
    std::int32_t facet = 0;
    std::int32_t one_sided = 0;
    std::int32_t two_sided = 0;
    friend auto operator<=>(const Incidence&, const Incidence&) = default;
  };
  std::vector<Facet> facets;
  std::vector<double> segment_lengths;
  std::vector<Incidence> incidences;  // ascending, without repeats
  BoundaryTopology boundary;          // of the one-sided subfacets
};

// Errors: kInternal if away from subsegments a facet does not go on over an edge, or folds there.
// Cost: O(n log n).
[[nodiscard]] Result<FacetCover> measure_facet_cover(const Constraints& constraints);

// `diameter`: of the model, for the flatness that facets are held to.
// Errors: kInternal, naming the facet or segment.
[[nodiscard]] Result<void> compare_facet_covers(const FacetCover& wanted,
                                                const FacetCover& found,
                                                double diameter);

}  // namespace symcell
