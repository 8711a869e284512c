// What each face of a planar map is: outside, hole, or meshed, with the region's attribute and
// area bound. As in Triangle: all that the segments enclose, less the faces with a hole seed.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/model/pslg.hpp"
#include "core/plane/input/planar_map.hpp"

namespace symcell::plane {

struct Subdomain {
  bool meshed = false;
  bool hole = false;         // bounded, with a hole seed
  std::int32_t region = -1;  // index of the first region seed in it, -1: none
  double area = 0;           // input units squared; 0 for the unbounded face
  Point2 moment;             // integral of (position - reference) over the face

  friend bool operator==(const Subdomain&, const Subdomain&) = default;
};

struct Subdomains {
  PlanarMap map;
  std::vector<Subdomain> faces;
  Point2 reference;  // middle of the bounding box: keeps the moments' digits

  [[nodiscard]] const Subdomain& left_of(std::int32_t half_edge) const {
    const auto face = map.face[static_cast<std::size_t>(half_edge)];
    return faces[static_cast<std::size_t>(face)];
  }
};

// Queries of the map are the hole seeds, then the region seeds; seeds that lie on a segment or in
// the unbounded face have no effect here (validate_pslg refuses them).
// Requires and errors: as make_planar_map.
[[nodiscard]] Result<Subdomains> make_subdomains(const Pslg& pslg, ExecutionContext& context);

}  // namespace symcell::plane
