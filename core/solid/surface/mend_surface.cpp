#include "core/solid/surface/mend_surface.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cmath>
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

class ShortEdges {
 public:
  ShortEdges(Mesh& mesh, double most)
      : mesh_(mesh),
        most_(most),
        moved_(mesh.add_property_map<Mesh::Vertex_index, double>("v:moved", 0).first) {}

  // Whether any was collapsed.
  bool collapse() {
    std::vector<std::pair<double, Mesh::Edge_index>> edges;
    for (const Mesh::Edge_index e : mesh_.edges()) {
      if (const double l = length(mesh_.halfedge(e)); l < most_) edges.emplace_back(l, e);
    }
    std::sort(edges.begin(), edges.end());
    bool any = false;
    for (const auto& [l, e] : edges) {
      if (mesh_.is_removed(e)) continue;
      const Mesh::Halfedge_index h = mesh_.halfedge(e);
      if (!CGAL::Euler::does_satisfy_link_condition(e, mesh_)) continue;
      const Mesh::Halfedge_index best =
          worst_after(h) >= worst_after(mesh_.opposite(h)) ? h : mesh_.opposite(h);
      if (worst_after(best) > 0) {
        collapse(best);
        any = true;
      }
    }
    return any;
  }

 private:
  [[nodiscard]] double length(Mesh::Halfedge_index h) const {
    return std::sqrt(CGAL::to_double(
        CGAL::squared_distance(mesh_.point(mesh_.source(h)), mesh_.point(mesh_.target(h)))));
  }

  // How far what became the end, or the start, would have moved.
  [[nodiscard]] double moved_by(Mesh::Halfedge_index h) const {
    return std::max(moved_[mesh_.target(h)], moved_[mesh_.source(h)] + length(h));
  }

  // With the start of h drawn to its end: the least share of a triangle's area that points to where
  // it pointed before; 0 if one turns over or a point would have moved too far.
  [[nodiscard]] double worst_after(Mesh::Halfedge_index h) const {
    if (moved_by(h) > most_) return 0;
    const Mesh::Vertex_index goes = mesh_.source(h), stays = mesh_.target(h);
    const Kernel::Point_3& place = mesh_.point(stays);
    double worst = 1;
    for (const Mesh::Halfedge_index in : mesh_.halfedges_around_target(mesh_.opposite(h))) {
      const Mesh::Vertex_index a = mesh_.source(in), b = mesh_.target(mesh_.next(in));
      if (a == stays || b == stays) continue;
      const Kernel::Point_3 &p = mesh_.point(goes), &q = mesh_.point(b), &r = mesh_.point(a);
      const Kernel::Vector_3 before = CGAL::cross_product(q - p, r - p),
                             after = CGAL::cross_product(q - place, r - place);
      const double after2 = after.squared_length(), before2 = before.squared_length();
      if (!(after2 > 0)) return 0;
      if (!(before2 > 0)) continue;
      worst = std::min(worst, before * after / std::sqrt(before2 * after2));
      if (worst <= kLeastTurn) return 0;
    }
    return worst;
  }

  void collapse(Mesh::Halfedge_index h) {
    const Kernel::Point_3 place = mesh_.point(mesh_.target(h));
    const double moved = moved_by(h);
    const Mesh::Vertex_index left = CGAL::Euler::collapse_edge(mesh_.edge(h), mesh_);
    mesh_.point(left) = place;
    moved_[left] = moved;
  }

  // Cosine of what a triangle may turn by: 60 degrees. Those that stand on a short edge turn most.
  static constexpr double kLeastTurn = 0.5;

  Mesh& mesh_;
  double most_;
  Mesh::Property_map<Mesh::Vertex_index, double> moved_;
};

}  // namespace

std::optional<IndexedSurface> collapse_short_edges(const IndexedSurface& surface, double most) {
  const bool any =
      std::any_of(surface.triangles.begin(), surface.triangles.end(), [&](const Triangle& t) {
        const Point3 &a = surface.points[t[0]], &b = surface.points[t[1]],
                     &c = surface.points[t[2]];
        return std::min({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)}) <
               most * most;
      });
  if (!any) return std::nullopt;
  return mended_by(surface, [&](Mesh& mesh) { return ShortEdges(mesh, most).collapse(); });
}

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
