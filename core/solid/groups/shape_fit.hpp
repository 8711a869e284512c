// Which simple surface a face is a tessellation of.
//
// Vertices of a tessellation lie on the true surface, its triangles beside it: the vertices are
// fitted, by least squares that are linear in the unknowns, and normals of triangles are asked
// whether they agree. A face that is none of the kinds within the tolerance is none of them:
// nothing is called by a kind for being near to it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/analytic_surface.hpp"
#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {

struct ShapeFit : AnalyticSurface {
  // Of a plane `origin` is the centroid, and `direction` looks outwards; of a cone `radius` is the largest.
  bool concave = false;  // the material is outside of it
  bool closes = false;   // goes round its axis without a wide gap
};

// `triangles`: of one face. `noise`: of the coordinates. The z axis is the first that is tried.
// Cost: O(T).
[[nodiscard]] ShapeFit fit_shape(const IndexedSurface& surface,
                                 const std::vector<std::int32_t>& triangles,
                                 double noise);

// The same of a surface that is known.
[[nodiscard]] ShapeFit complete_shape(const AnalyticSurface& known,
                                      const IndexedSurface& surface,
                                      const std::vector<std::int32_t>& triangles,
                                      double noise);

}  // namespace symcell::solid
