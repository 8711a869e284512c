#include "tests/property/orbit_insertion_reference.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>

#include "core/cell/full_mesh.hpp"

namespace symcell {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<bool,
                                              Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

// Face::info() is true outside the domain.
void flood_outside(Cdt::Face_handle seed) {
  std::vector<Cdt::Face_handle> stack{seed};
  while (!stack.empty()) {
    const Cdt::Face_handle face = stack.back();
    stack.pop_back();
    if (face->info()) continue;
    face->info() = true;
    for (int i = 0; i < 3; ++i) {
      if (!face->is_constrained(i)) stack.push_back(face->neighbor(i));
    }
  }
}

}  // namespace

OrbitInsertionReference insert_orbits(const SymmetryCellMesh& cell,
                                      const std::vector<Point2>& holes) {
  const FullMeshView view(cell);
  Cdt cdt;
  std::vector<Cdt::Vertex_handle> handles(static_cast<std::size_t>(view.node_count()));
  const auto insert = [&](std::int64_t id) {
    const OrbitVertex v = view.node(id);
    const Point3 p = cell.orbit_points[static_cast<std::size_t>(v.orbit)];
    const Point2 x = view.rotations().rotate(Point2{p.x, p.y}, v.exponent);
    const Cdt::Vertex_handle handle = cdt.insert(Cdt::Point(x.x, x.y));
    handle->info() = static_cast<std::int32_t>(id);
    handles[static_cast<std::size_t>(id)] = handle;
  };
  // Copies of one orbit follow each other, `off_axis` ids apart.
  const std::int64_t axis = std::count(cell.on_axis.begin(), cell.on_axis.end(), 1);
  const std::int64_t centre = cell.fold > 1 ? axis : 0;
  const std::int64_t off_axis = (view.node_count() - centre) / cell.fold;
  for (std::int64_t orbit = 0; orbit < off_axis; ++orbit) {
    for (std::int64_t k = 0; k < cell.fold; ++k) insert(orbit + k * off_axis);
  }
  for (std::int64_t id = off_axis * cell.fold; id < view.node_count(); ++id) insert(id);

  for (std::int32_t sector = 0; sector < cell.fold; ++sector) {
    for (std::size_t b = 0; b + 1 < cell.boundary.size(); b += 2) {
      const auto end = [&](std::size_t i) {
        return handles[static_cast<std::size_t>(
            view.node_id(static_cast<std::size_t>(cell.boundary[i]), sector))];
      };
      cdt.insert_constraint(end(b), end(b + 1));
    }
  }

  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->info() = false;
  flood_outside(cdt.infinite_face());
  for (const Point2 hole : holes) {
    const Point2 x = hole - Point2{cell.axis_origin.x, cell.axis_origin.y};
    flood_outside(cdt.locate(Cdt::Point(x.x, x.y)));
  }

  OrbitInsertionReference result;
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
    if (f->info()) continue;
    ++result.triangles;
    for (int i = 0; i < 3; ++i) {
      const std::int32_t a = f->vertex(Cdt::ccw(i))->info(), b = f->vertex(Cdt::cw(i))->info();
      result.edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  std::sort(result.edges.begin(), result.edges.end());
  result.edges.erase(std::unique(result.edges.begin(), result.edges.end()), result.edges.end());
  return result;
}

}  // namespace symcell
