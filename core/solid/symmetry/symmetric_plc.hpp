// A PLC made exactly symmetric: one representative per orbit of vertices, and which of its segments
// and facets are copies of each other.
//
// Invariants:
// - point i of the complex lies at rotation^exponent of its orbit's point, in the local frame;
// points
//   of the axis have exponent 0 and x = y = 0;
// - what meets the axis is cut there: no segment crosses it between its ends, a facet that it
//   pierces has a point there, one that contains a piece of it has that piece as a segment;
// - the rotated copy of every segment and facet is one of the complex.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/orbit_vertex.hpp"
#include "core/solid/plc/plc_complex.hpp"
#include "core/solid/symmetry/plc_fit.hpp"
#include "core/solid/symmetry/solid_symmetry.hpp"

namespace symcell::solid {

struct FacetOrbit {
  std::int32_t facet = 0;  // of the complex: the representative
  // The order of the rotations that map the facet onto itself (about the axis it is normal to, or
  // half a turn about an axis it contains); divides the fold.
  std::int32_t self_copies = 1;
};

struct SymmetricPlc {
  Symmetry symmetry;
  PlcComplex complex;  // points in the local frame, exactly symmetric but for the last roundings
  std::vector<Point3> orbit_points;
  std::vector<std::uint8_t> on_axis;     // per orbit
  std::vector<OrbitVertex> vertex;       // per point of the complex
  std::vector<std::int32_t> edge_orbit;  // per edge of the complex
  std::vector<std::int32_t> edge_of;     // per edge orbit: its representative in the complex
  std::vector<FacetOrbit> facet_orbits;
  bool ignore_markers = false;
  double volume = 0;  // of the meshed domain
};

// Averages every orbit of vertices and cuts what meets the axis.
// `fit`: accepted.  Sets fold, frame, error and diameter of `symmetry`.
// Errors: kNotSymmetric, kSelfIntersection where the averaged model is not sound; limits.
[[nodiscard]] Result<SymmetricPlc> make_symmetric_plc(const PlcComplex& complex,
                                                      const PlcFit& fit,
                                                      bool ignore_markers,
                                                      ExecutionContext& context);

}  // namespace symcell::solid
