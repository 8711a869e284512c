// Which axes and folds a PLC may have, from its vertices and facets.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/axis_frame.hpp"
#include "core/solid/plc/plc_complex.hpp"

namespace symcell::solid {

struct AxisCandidate {
  AxisFrame frame;
  // The greatest fold that the numbers of vertices at equal radius and height allow; all others
  // divide it.  0: all vertices lie on the axis.
  std::int64_t greatest_fold = 1;
};

struct AxisCandidates {
  std::vector<AxisCandidate> list;  // greatest folds first
  // Two moments are equal: an axis of half a turn may run elsewhere, normal to the third.
  bool open = false;
  // All three are equal: an axis of any fold may run elsewhere.
  bool isotropic = false;
};

// The axes through the vertices' centroid (or `origin`) along the eigenvectors of the second
// moments; or the one along `direction`. `tolerance`: input units.  Cost: O(N log N).
[[nodiscard]] AxisCandidates principal_axes(const PlcComplex& complex,
                                            const std::optional<Point3>& origin,
                                            const std::optional<Point3>& direction,
                                            double tolerance);

// Axes elsewhere that allow a fold above 1, for where equal moments leave them open: to vertices,
// facet centroids and edge midpoints, and those that turn one vertex into two others like it. Cost:
// O(N log N) a direction; the number of directions is bounded.
[[nodiscard]] std::vector<AxisCandidate> scattered_axes(const PlcComplex& complex,
                                                        const std::optional<Point3>& origin,
                                                        double tolerance);

}  // namespace symcell::solid
