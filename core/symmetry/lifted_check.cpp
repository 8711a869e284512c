#include "core/symmetry/lifted_check.hpp"

#include "core/geometry/rotation.hpp"
#include "core/model/describe.hpp"
#include "core/model/subdomains.hpp"

namespace symcell {
namespace {

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

Pslg lift_pslg(const SymmetricPslg& symmetric) {
  const RotationTable rotations(symmetric.fold);
  const std::int32_t fold = symmetric.fold;
  const auto orbits = static_cast<std::int32_t>(symmetric.orbit_points.size());
  Pslg lifted;
  // The centre has one copy: orbits behind it move up by one orbit.
  const std::int32_t centre = symmetric.centre_orbit;
  const auto index_of = [&](OrbitVertex v, std::int32_t turn) {
    if (v.orbit == centre) return (orbits - 1) * fold;
    const std::int32_t row = centre >= 0 && v.orbit > centre ? v.orbit - 1 : v.orbit;
    return row * fold + rotations.add(v.exponent, turn);
  };
  for (std::int32_t o = 0; o < orbits; ++o) {
    if (o == centre) continue;
    for (std::int32_t k = 0; k < fold; ++k) {
      lifted.vertices.push_back(rotations.rotate(symmetric.orbit_points[at(o)], k));
    }
  }
  if (centre >= 0) lifted.vertices.push_back({0, 0});
  for (std::size_t s = 0; s < symmetric.segments.size(); ++s) {
    const SymmetricSegment& segment = symmetric.segments[s];
    for (std::int32_t k = 0; k < fold; ++k) {
      lifted.segments.push_back(
          {index_of(segment.a, k), index_of(segment.b, k), symmetric.segment_marker(s, k)});
    }
  }
  lifted.holes = symmetric.holes;
  lifted.regions = symmetric.regions;
  return lifted;
}

Result<void> check_lifted(const SymmetricPslg& symmetric,
                          const ClosedOrbits&,
                          ExecutionContext& context) {
  const Pslg lifted = lift_pslg(symmetric);
  auto subdomains = make_subdomains(lifted, context);
  const std::string advice =
      " once the vertices are moved to symmetric places; lower the symmetry tolerance, or mend the "
      "model where it is nearly degenerate";
  if (!subdomains) {
    const Error& error = subdomains.error();
    const bool geometric = error.code == ErrorCode::kSelfIntersection ||
                           error.code == ErrorCode::kOverlappingSegments ||
                           error.code == ErrorCode::kDuplicateVertices;
    if (!geometric) return tl::unexpected(error);
    return fail(ErrorCode::kNotSymmetric, "segments cross, overlap or shrink to nothing" + advice);
  }
  if (subdomains->map.cuts > 0 || subdomains->map.pieces.size() != lifted.segments.size()) {
    return fail(ErrorCode::kNotSymmetric, "a vertex comes to lie on a segment" + advice);
  }
  return {};
}

}  // namespace symcell
