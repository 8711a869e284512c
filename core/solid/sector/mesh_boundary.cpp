#include "core/solid/sector/mesh_boundary.hpp"

#include <vector>

namespace symcell::solid {

IndexedSurface full_boundary(const QuotientTetrahedralization& mesh) {
  const std::int32_t fold = mesh.fold();
  IndexedSurface full;
  // Of copy 0 of each orbit; the others follow it.
  std::vector<std::int32_t> first(mesh.vertex_slots(), -1);
  const auto id_of = [&](OrbitVertex v) {
    std::int32_t& own = first[static_cast<std::size_t>(v.orbit)];
    if (own < 0) {
      own = static_cast<std::int32_t>(full.points.size());
      const std::int32_t copies = mesh.on_axis(v.orbit) ? 1 : fold;
      for (std::int32_t k = 0; k < copies; ++k) full.points.push_back(mesh.lift(v.orbit, k));
    }
    return own + (mesh.on_axis(v.orbit) ? 0 : v.exponent);
  };
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (mesh.tet(t).nb[i] != kNoHalfFace) continue;
      for (std::int32_t k = 0; k < fold; ++k) {
        Triangle corners{};
        for (std::size_t c = 0; c < 3; ++c) {
          corners[c] = id_of(mesh.shift(mesh.corner(t, kFaceCorners[i][c]), k));
        }
        full.triangles.push_back(corners);
      }
    }
  }
  return full;
}

}  // namespace symcell::solid
