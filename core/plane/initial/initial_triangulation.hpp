// The initial symmetric constrained Delaunay triangulation, as a quotient.
//
// The CDT of the whole symmetric PSLG is computed with exact predicates (CGAL). Cocircular points
// break symmetry: an edge whose n copies are not all present is dropped, which merges the triangles
// at it; the triangles of one merged face per orbit are kept and glued by their edges' orbits.
// Lawson flips in the quotient then settle what the ties left. Source: [paper] sec. 3.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/plane/quotient/quotient_triangulation.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane {

// One orbit of subdomains: the faces that Triangle::face names.
struct SubdomainOrbit {
  std::int32_t attribute = 0;
  double max_area = std::numeric_limits<double>::infinity();
};

// Attribute of the region at a point of the whole model, for attributes that differ between copies.
class RegionLocator {
 public:
  virtual ~RegionLocator() = default;
  // `x`: relative to the centre, inside the domain.
  [[nodiscard]] virtual std::int32_t attribute_at(Point2 x) const = 0;
};

struct InitialTriangulation {
  QuotientTriangulation mesh;
  std::vector<SubdomainOrbit> subdomains;
  std::unique_ptr<RegionLocator> locator;  // null where attributes are the same in every sector
};

// Errors: kDegenerateGeometry (nothing left to mesh), kNotSymmetric (hole or region seeds make the
// domain asymmetric), kSelfIntersection (segments cross once made symmetric), limits.
// Cost: O(nN log nN) for N orbits of vertices.
[[nodiscard]] Result<InitialTriangulation> triangulate_initial(const SymmetricPslg& pslg,
                                                               ExecutionContext& context);

}  // namespace symcell::plane
