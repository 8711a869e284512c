#include "core/solid/surface/mend_surface.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

namespace symcell::solid {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace PMP = CGAL::Polygon_mesh_processing;

// Calls mend(mesh); false or an exception of the library means nothing was mended.
template <class Mend>
std::optional<IndexedSurface> mended_by(const IndexedSurface& surface, const Mend& mend) {
  std::vector<Kernel::Point_3> points;
  points.reserve(surface.points.size());
  for (const Point3& p : surface.points) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::vector<std::size_t>> polygons;
  polygons.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles) {
    polygons.push_back({static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                        static_cast<std::size_t>(t[2])});
  }
  IndexedSurface mended;
  try {
    if (!PMP::is_polygon_soup_a_polygon_mesh(polygons)) return std::nullopt;
    Mesh mesh;
    PMP::polygon_soup_to_polygon_mesh(points, polygons, mesh);
    auto source = mesh.add_property_map<Mesh::Face_index, std::int32_t>("f:source", -1).first;
    std::size_t next = 0;
    for (const Mesh::Face_index f : mesh.faces()) source[f] = surface.source[next++];
    if (!mend(mesh)) return std::nullopt;
    mesh.collect_garbage();
    if (!CGAL::is_closed(mesh) || !CGAL::is_triangle_mesh(mesh)) return std::nullopt;
    for (const Mesh::Vertex_index v : mesh.vertices()) {
      const Kernel::Point_3& p = mesh.point(v);
      mended.points.push_back({p.x(), p.y(), p.z()});
    }
    for (const Mesh::Face_index f : mesh.faces()) {
      Triangle t{};
      std::size_t i = 0;
      for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f))) {
        t[i++] = static_cast<std::int32_t>(v.idx());
      }
      mended.triangles.push_back(t);
      mended.source.push_back(source[f]);
    }
  } catch (const std::exception&) {
    return std::nullopt;  // a precondition of the library that this surface breaks
  }
  return mended;
}

}  // namespace

std::optional<IndexedSurface> remove_flat_triangles(const IndexedSurface& surface) {
  const auto point = [&](std::int32_t v) {
    const Point3& p = surface.points[v];
    return Kernel::Point_3(p.x, p.y, p.z);
  };
  const bool any = std::any_of(
      surface.triangles.begin(), surface.triangles.end(),
      [&](const Triangle& t) { return CGAL::collinear(point(t[0]), point(t[1]), point(t[2])); });
  if (!any) return surface;
  return mended_by(surface, [](Mesh& mesh) { return PMP::remove_degenerate_faces(mesh); });
}

}  // namespace symcell::solid
