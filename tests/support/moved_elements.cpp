#include "tests/support/moved_elements.hpp"

#include <algorithm>
#include <vector>

#include "core/cell/full_mesh.hpp"

namespace symcell::test {
namespace {

// Index of a node, added if it is new.
std::int32_t index_of(std::vector<OrbitVertex>& nodes, OrbitVertex wanted) {
  const auto found = std::ranges::find(nodes, wanted);
  const auto index = static_cast<std::int32_t>(found - nodes.begin());
  if (found == nodes.end()) nodes.push_back(wanted);
  return index;
}

}  // namespace

SymmetryCellMesh with_elements_moved(const SymmetryCellMesh& cell,
                                     std::int32_t exponent,
                                     const std::function<bool(std::size_t)>& chosen) {
  const FullMeshView view(cell);
  const auto k = static_cast<std::size_t>(cell.nodes_per_element);
  SymmetryCellMesh mesh = cell;
  mesh.nodes.clear();
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    OrbitVertex v = cell.nodes[static_cast<std::size_t>(cell.elements[i])];
    const bool on_axis = cell.on_axis[static_cast<std::size_t>(v.orbit)] != 0;
    if (chosen(i / k) && !on_axis) v.exponent = view.rotations().add(v.exponent, exponent);
    mesh.elements[i] = index_of(mesh.nodes, v);
  }
  mesh.node_markers.assign(mesh.nodes.size(), 0);
  mesh.boundary.clear();
  mesh.boundary_markers.clear();
  mesh.boundary_is_higher_image.clear();
  mesh.lower_facets.clear();
  mesh.higher_facets.clear();
  mesh.lower_to_higher.assign(mesh.nodes.size(), -1);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    OrbitVertex image = mesh.nodes[i];
    const bool on_axis = cell.on_axis[static_cast<std::size_t>(image.orbit)] != 0;
    if (!on_axis) image.exponent = view.rotations().add(image.exponent, 1);
    const auto found = std::ranges::find(mesh.nodes, image);
    if (found == mesh.nodes.end()) continue;
    mesh.lower_to_higher[i] = static_cast<std::int32_t>(found - mesh.nodes.begin());
  }
  return mesh;
}

}  // namespace symcell::test
