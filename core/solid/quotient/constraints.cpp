#include "core/solid/quotient/constraints.hpp"

namespace symcell::solid {

Constraints constraints_of(const QuotientTetrahedralization& mesh, std::int32_t axis_segment) {
  Constraints out;
  out.fold = mesh.fold();
  for (std::size_t i = 0; i < mesh.vertex_slots(); ++i) {
    const auto v = static_cast<VertexId>(i);
    out.points.push_back(mesh.point(v));
    out.on_axis.push_back(mesh.on_axis(v) ? 1 : 0);
  }
  const auto copy = [](OrbitVertex c) { return OrbitVertex{c.orbit, c.exponent}; };
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Tet& tet = mesh.tet(t);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const HalfFace h = 4 * t + i, g = tet.nb[i];
      // One with the solid on both sides is listed once.
      if (tet.facet[i] == kNoFacet || (g != kNoHalfFace && g < h)) continue;
      Subfacet& s = out.subfacets.emplace_back();
      for (std::size_t j = 0; j < 3; ++j) s.corners[j] = copy(mesh.corner(t, kFaceCorners[i][j]));
      s.facet = tet.facet[i];
      s.two_sided = g != kNoHalfFace;
    }
  }
  mesh.edges().for_each([&](const EdgeKey& key, std::int32_t segment) {
    if (segment == axis_segment) return;
    out.subsegments.push_back({{key.a, 0}, {key.b, key.exponent}, segment});
  });
  return out;
}

}  // namespace symcell::solid
