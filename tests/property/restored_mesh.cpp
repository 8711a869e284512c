#include "tests/property/restored_mesh.hpp"

#include "core/cell/full_mesh.hpp"

namespace symcell {

RestoredMesh restore(const SymmetryCellMesh& cell) {
  const FullMeshView view(cell);
  RestoredMesh mesh;
  for (std::int64_t id = 0; id < view.node_count(); ++id) {
    const Point3 p = view.position(view.node(id));
    mesh.points.push_back({p.x, p.y});
  }
  const auto stride = static_cast<std::size_t>(cell.nodes_per_element);
  for (std::int32_t sector = 0; sector < view.sectors(); ++sector) {
    for (std::size_t e = 0; e < cell.element_count(); ++e) {
      std::array<std::int32_t, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto node = static_cast<std::size_t>(cell.elements[e * stride + i]);
        corners[i] = static_cast<std::int32_t>(view.node_id(node, sector));
      }
      mesh.triangles.push_back(corners);
      mesh.regions.push_back(cell.region(e, sector));
    }
  }
  mesh.cell_triangles = cell.element_count();
  return mesh;
}

}  // namespace symcell
