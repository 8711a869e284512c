// A closed surface with n-fold symmetry, one triangle an orbit: the sector between two cuts, glued.
//
// Invariants: corner (orbit, exponent) lies at rotation^exponent of points[orbit]; the exponent is
// 0, or 1 for vertices of the cut where the triangle touches the higher cut; on the axis it is 0
// and x = y = 0. Vertices of the cut lie in the half-plane at start_angle, all others strictly
// between it and its image. Every edge, as a pair of orbits with relative exponent, has two
// triangles. Fold 1: no cut, no axis, exponents 0.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/orbit_vertex.hpp"
#include "core/geometry/point.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::solid {

using QuotientTriangle = std::array<OrbitVertex, 3>;

// Points x with dot(normal, x) = offset.
struct Plane {
  Point3 normal;
  double offset = 0;
  [[nodiscard]] double height(Point3 p) const { return dot(normal, p) - offset; }
};

struct QuotientSurface {
  std::int32_t fold = 1;
  double start_angle = 0;
  std::vector<Point3> points;  // per orbit, local frame
  std::vector<std::uint8_t> on_axis;
  std::vector<std::uint8_t> on_cut;  // axis vertices too
  std::vector<QuotientTriangle> triangles;
  // Unit normals of the input's triangles that these came from: what an inverted triangle shows
  // against.
  std::vector<Point3> normals;

  // Planar patches: triangle t with patch[t] = p >= 0 lies in rotation^frame[t] of planes[p];
  // -1: a plane of its own. Planes normal to the axis have frame 0. Empty until found.
  std::vector<Plane> planes;
  std::vector<std::int32_t> patch;
  std::vector<std::int32_t> frame;
};

// A side of a triangle; sides of one edge have equal (low, high, exponent).
struct QuotientEdgeUse {
  std::int32_t low = 0;  // orbits, low <= high
  std::int32_t high = 0;
  std::int32_t exponent = 0;  // of high relative to low; 0 if either is on the axis
  std::int32_t triangle = 0;
  std::int32_t side = 0;   // from corner `side` to the next
  std::int32_t frame = 0;  // exponent of the reference corner in the triangle
  bool forward = false;    // the triangle runs from low to high
};

// All sides, sorted, sides of one edge together.
[[nodiscard]] std::vector<QuotientEdgeUse> sorted_edge_uses(const QuotientSurface& surface);

[[nodiscard]] inline bool same_edge(const QuotientEdgeUse& a, const QuotientEdgeUse& b) {
  return a.low == b.low && a.high == b.high && a.exponent == b.exponent;
}

struct QuotientNeighbour {
  std::int32_t triangle = -1;
  std::int32_t side = -1;
  std::int32_t exponent = 0;  // the neighbour turned by this many steps adjoins the triangle
};

// Per triangle, by side.  Errors: kInternal if an edge has not two triangles running against each
// other.
[[nodiscard]] Result<std::vector<std::array<QuotientNeighbour, 3>>> find_neighbours(
    const QuotientSurface& surface);

[[nodiscard]] inline Point3 corner_point(const QuotientSurface& surface,
                                         const RotationTable& rotations,
                                         OrbitVertex corner) {
  return rotations.rotate(surface.points[corner.orbit], corner.exponent);
}

// rotation^exponent of a plane through or beside the axis; `exponent` may be negative.
[[nodiscard]] Plane rotated(const Plane& plane,
                            const RotationTable& rotations,
                            std::int32_t exponent);

// Volume enclosed by all copies together: the cuts' own sides add nothing, as they hold the axis.
[[nodiscard]] double full_volume(const QuotientSurface& surface);

}  // namespace symcell::solid
