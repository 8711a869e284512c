#include "core/guard/check_curved.hpp"

#include <algorithm>
#include <array>

#include "core/cell/full_mesh.hpp"
#include "core/geometry/quadratic_tet.hpp"
#include "core/geometry/tet_measures.hpp"

namespace symcell {
namespace {

bool is_positive(const std::array<Point2, 6>& node) {
  // Control points of the sides: the mid-side nodes lie on them at a half.
  const auto control = [&](std::size_t i) {
    return 2 * node[3 + i] - 0.5 * (node[i] + node[(i + 1) % 3]);
  };
  const Point2 c01 = control(0), c12 = control(1), c20 = control(2);
  // Derivatives along the sides 01 and 02 at the corners; between them they are linear.
  const std::array<Point2, 3> u{c01 - node[0], node[1] - c01, c12 - c20};
  const std::array<Point2, 3> v{c20 - node[0], c12 - c01, node[2] - c20};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(cross(u[i], v[i]) > 0)) return false;
    for (std::size_t j = i + 1; j < 3; ++j) {
      if (!(cross(u[i], v[j]) + cross(u[j], v[i]) > 0)) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::size_t> folded_elements(const SymmetryCellMesh& mesh) {
  const FullMeshView full(mesh);
  std::vector<std::size_t> folded;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    std::array<Point2, 6> node;
    for (std::size_t i = 0; i < 6; ++i) {
      const Point3 p = full.cell_node_position(static_cast<std::size_t>(mesh.elements[6 * e + i]));
      node[i] = {p.x, p.y};
    }
    if (!is_positive(node)) folded.push_back(e);
  }
  return folded;
}

std::vector<std::size_t> folded_tetrahedra(const SymmetryCellMesh& mesh, double least) {
  const FullMeshView full(mesh);
  std::vector<std::size_t> folded;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    QuadraticTet p;
    for (std::size_t i = 0; i < 10; ++i) {
      p[i] = full.cell_node_position(static_cast<std::size_t>(mesh.elements[10 * e + i]));
    }
    const double straight = six_volumes(p[0], p[1], p[2], p[3]);
    const auto coefficients = jacobian_coefficients(p);
    const double smallest = *std::min_element(coefficients.begin(), coefficients.end());
    if (!(smallest > least * straight) || !(straight > 0)) folded.push_back(e);
  }
  return folded;
}

}  // namespace symcell
