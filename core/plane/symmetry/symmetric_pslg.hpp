// A PSLG made exactly symmetric: one representative per orbit under C_n, in coordinates relative to
// the centre. What the initial triangulation starts from; n = 1 is the same thing with one copy.
//
// Invariants:
// - vertex (orbit, k) lies at rotation^k(orbit_points[orbit]); all n copies are vertices of the
//   PSLG; the centre, if it is a vertex, is orbit `centre_orbit` at (0, 0) and has exponent 0 only;
// - segments: one per orbit; its n copies (n / 2 never occurs: a segment through the centre is cut
//   there) are all segments; no two copies cross or overlap;
// - no vertex lies in the interior of a segment; no two vertices coincide.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cell/warning.hpp"
#include "core/geometry/orbit_vertex.hpp"
#include "core/geometry/point.hpp"
#include "core/model/pslg.hpp"

namespace symcell::plane {

struct SymmetricSegment {
  OrbitVertex a;  // not the centre unless b is not; a.exponent is 0 unless a is the centre
  OrbitVertex b;
  // First entry of this orbit in `segment_markers`: copy k has marker segment_markers[first + k] if
  // markers differ between copies (ignore_markers), else all copies share segment_markers[first].
  std::int32_t first_marker = 0;
  bool divided = false;  // as asked for: it gets no more vertices
};

struct SymmetricPslg {
  std::int32_t fold = 1;
  std::int32_t centre_orbit = -1;    // index in orbit_points, -1: the centre is no vertex
  Point2 centre;                     // input coordinates
  std::vector<Point2> orbit_points;  // relative to the centre
  std::vector<SymmetricSegment> segments;
  std::vector<std::int32_t> segment_markers;
  // Per segment: that of the arc which it is a chord of, from a to b (core/geometry/arc.hpp); empty:
  // there are no arcs.
  std::vector<double> bulges;
  bool uniform_markers = true;  // one marker an orbit of segments
  bool ignore_markers = false;  // regions may differ between copies
  // Seeds of all copies, relative to the centre, as in the input.
  std::vector<Point2> holes;
  std::vector<PslgRegion> regions;

  // What was found, for statistics and `inspect`.
  double symmetry_error_rel = 0;  // largest move of a vertex / diameter
  double diameter = 0;            // of the input, bounding-box diagonal
  // Not 0 where vertices of the input need not be vertices here, or are moved by more than the usual
  // tolerance: the share of the diameter to which its segments keep their places.
  double shape_tolerance_rel = 0;
  // Copies of vertices where the model has none, as all sectors got the vertices of all for want of
  // an outline that fits; 0 where that was asked for.
  std::size_t copied_vertices = 0;
  std::int32_t geometry_fold = 1;  // the fold with markers and region attributes set aside
  bool fold_detected = false;
  bool centre_detected = false;
  std::vector<Warning> warnings;  // of the choice of fold

  [[nodiscard]] std::int32_t segment_marker(std::size_t segment, std::int32_t copy) const {
    const auto first = static_cast<std::size_t>(segments[segment].first_marker);
    return segment_markers[uniform_markers ? first : first + static_cast<std::size_t>(copy)];
  }
  // Whether any copy of the segment has the marker.
  [[nodiscard]] bool has_marker(std::size_t segment, std::int64_t marker) const {
    for (std::int32_t k = 0; k < (uniform_markers ? 1 : fold); ++k) {
      if (segment_marker(segment, k) == marker) return true;
    }
    return false;
  }
};

}  // namespace symcell::plane
