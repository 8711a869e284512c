// One exact sector of a solid's boundary and internal facets: what the initial tetrahedralization
// starts from. The wedge is start_angle <= phi <= start_angle + 360/n about the z axis of the local
// frame; its two flat sides are not part of it (the section is made from the cut's curves).
// For n = 1 the sector is the whole model and nothing is cut.
//
// Invariants:
// - sector vertex i lies at rotation^exponent of orbit_points[orbit], exponent 0 or 1; exponent 1
//   means on the higher cut, and then (orbit, 0) is a sector vertex too, on the lower cut: the
//   higher cut's curve is the lower one's image bit by bit. Axis vertices have exponent 0;
// - faces are non-degenerate triangles that meet in common edges and vertices only; rotating them
// by
//   all n exponents gives the surface (and internal facets) of the whole model, each face once;
// - no face lies in the planes of the two cuts; a face edge in the lower cut's half-plane has both
//   ends on the cut (lower_cut edges, below) and its image in the higher one is a face edge too;
// - every edge that is not between two coplanar faces of one facet is in `edges`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/geometry/axis_frame.hpp"
#include "core/geometry/orbit_vertex.hpp"
#include "core/geometry/point.hpp"

namespace symcell::solid {

enum class SectorVertexKind : std::uint8_t {
  kFixed,      // a vertex of the input: stays
  kOnSegment,  // inside a segment of the input (where the cut crosses it): may slide or go
  kOnFacet     // inside a facet: may move in its plane or go
};

struct SectorFace {
  std::array<std::int32_t, 3>
      v{};                 // sector vertices; closed surfaces: counter-clockwise from outside
  std::int32_t facet = 0;  // see Sector::facet_markers
};

struct SectorEdge {
  std::int32_t a = 0;  // sector vertices
  std::int32_t b = 0;
  // Orbit of segments: pieces of one straight segment share it, also across the cut.
  std::int32_t segment = 0;
};

// As given, for all copies, in the local frame.
struct SectorRegion {
  Point3 point;
  std::int32_t attribute = 0;
  double max_volume = std::numeric_limits<double>::infinity();
};

struct Sector {
  std::int32_t fold = 1;
  double start_angle = 0;               // radians; of the half-plane of the lower cut
  std::vector<Point3> orbit_points;     // local frame
  std::vector<std::uint8_t> on_axis;    // per orbit; such a point has x = y = 0
  std::vector<SectorVertexKind> kinds;  // per orbit
  std::vector<OrbitVertex> vertices;    // sector vertices
  std::vector<SectorFace> faces;
  std::vector<SectorEdge> edges;
  // Edges of the lower cut's curve: sector vertices with exponent 0 (axis vertices included).
  std::vector<std::array<std::int32_t, 2>> lower_cut;
  // Pieces of the axis inside the closed wedge's material need not be given; points where the axis
  // pierces a face are sector vertices.

  // Facets are orbits of planar patches; copies of one facet have one index, also across the cut.
  std::vector<std::int32_t> facet_markers;    // per facet
  std::vector<std::int32_t> segment_markers;  // per segment

  // What is material and what void: nesting of closed shells (surfaces: odd depth is material), or
  // seeds (PLCs: everything enclosed but what hole seeds reach).
  bool nesting_decides = false;
  std::vector<Point3> holes;  // local frame, all copies
  std::vector<SectorRegion> regions;
  bool ignore_markers = false;  // regions may differ between copies

  // Surfaces, whose triangles differ from cut to cut: corners of facets too narrow for the default
  // radius-edge bound, and an estimate of the elements that the triangles take.
  std::int64_t narrow_corners = 0;
  double meshing_cost = 0;
  // Triangles of all the surfaces that this one was chosen from.
  std::size_t triangles_made = 0;

  // Volume of the whole model's enclosed space by its boundary alone, 0 if unknown. A check.
  double expected_volume = 0;
};

}  // namespace symcell::solid
