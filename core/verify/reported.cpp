#include <algorithm>
#include <limits>

#include "core/geometry/predicates.hpp"
#include "core/geometry/predicates_3.hpp"
#include "core/geometry/tet_figures.hpp"
#include "core/verify/support.hpp"

namespace symcell::internal {
namespace {

void tell_planar_quality(const MeshData& mesh, Checks& checks) {
  double cot_max = -std::numeric_limits<double>::infinity();
  double cot_min = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const std::array<Point3, 4> p = corners_of(mesh, e);
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
      const double cot = dot(u, v) / length(cross(u, v));
      cot_max = std::max(cot_max, cot);
      cot_min = std::min(cot_min, cot);
    }
  }
  checks.add("cell.quality", true,
             "angles " + shown(degrees_of_cotangent(cot_max)) + " to " +
                 shown(degrees_of_cotangent(cot_min)) + " degrees");
}

}  // namespace

void tell_quality(const MeshData& mesh, Checks& checks) {
  if (mesh.dimension == 2) {
    tell_planar_quality(mesh, checks);
    return;
  }
  double cot_max = -std::numeric_limits<double>::infinity();
  double cot_min = std::numeric_limits<double>::infinity();
  double radius_edge = 0, aspect = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const TetFigures f = tet_figures(corners_of(mesh, e));
    cot_max = std::max(cot_max, f.dihedral_cot_max);
    cot_min = std::min(cot_min, f.dihedral_cot_min);
    radius_edge = std::max(radius_edge, f.radius_edge);
    aspect = std::max(aspect, f.aspect);
  }
  checks.add("cell.quality", true,
             "dihedral angles " + shown(degrees_of_cotangent(cot_max)) + " to " +
                 shown(degrees_of_cotangent(cot_min)) + " degrees, radius-edge ratio up to " +
                 shown(radius_edge) + ", aspect ratio up to " + shown(aspect));
}

void tell_delaunay(const FacetedMesh& full, const std::vector<char>& constrained, Checks& checks) {
  const MeshData& mesh = full.mesh;
  std::size_t inner = 0;
  std::size_t delaunay = 0;
  for (std::size_t g = 0; g < full.group_count(); ++g) {
    if (full.sides(g) != 2 || constrained[g] != 0) continue;
    const std::array<Point3, 4> p =
        corners_of(mesh, static_cast<std::size_t>(full.first(g).element));
    const HalfFacet& other = full.second(g);
    const Point3 q = corners_of(
        mesh, static_cast<std::size_t>(other.element))[static_cast<std::size_t>(other.opposite)];
    ++inner;
    const Sign inside = mesh.dimension == 2
                            ? in_circle(planar(p[0]), planar(p[1]), planar(p[2]), planar(q))
                            : in_sphere(p[0], p[1], p[2], p[3], q);
    if (inside != Sign::kPositive) ++delaunay;
  }
  const double share = inner == 0 ? 1 : static_cast<double>(delaunay) / static_cast<double>(inner);
  checks.add("full.delaunay", true,
             shown(100 * share) + " % of " + std::to_string(inner) + " free " +
                 (mesh.dimension == 2 ? "edges" : "faces"));
}

}  // namespace symcell::internal
