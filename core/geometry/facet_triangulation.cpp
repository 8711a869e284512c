#include "core/geometry/facet_triangulation.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>

namespace symcell {
namespace {

struct FaceInfo {
  std::int32_t enclosure = -1;  // component between segments
  std::int32_t piece = -1;      // component between segments and cuts
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using ConstrainedFaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel, ConstrainedFaceBase>;
using Tds = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    Tds,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;
using VertexHandle = Cdt::Vertex_handle;
using FaceHandle = Cdt::Face_handle;

Failure crossing(IndexPair edge) {
  return fail(ErrorCode::kSelfIntersection, "edges of a facet cross or touch in its plane",
              {edge[0], edge[1]});
}

class Triangulator {
 public:
  Triangulator(std::span<const Point3> points, const FacetGraph& graph)
      : points_(points), graph_(graph) {}

  Result<FacetTriangles> run() {
    SYMCELL_TRY(insert_vertices());
    if (cdt_.dimension() < 2) {
      return fail(ErrorCode::kDegenerateFacet, "a facet's vertices lie on one line");
    }
    SYMCELL_TRY(insert_edges(graph_.segments));
    SYMCELL_TRY(insert_edges(graph_.cuts));
    return collect();
  }

 private:
  Result<void> insert_vertices() {
    for (const auto& edges : {&graph_.segments, &graph_.cuts}) {
      for (const IndexPair& e : *edges) ids_.insert(ids_.end(), e.begin(), e.end());
    }
    ids_.insert(ids_.end(), graph_.points.begin(), graph_.points.end());
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
    handles_.reserve(ids_.size());
    FaceHandle hint;
    for (const std::int32_t id : ids_) {
      const std::size_t before = cdt_.number_of_vertices();
      const VertexHandle v = cdt_.insert(plane_point(points_[static_cast<std::size_t>(id)]), hint);
      if (cdt_.number_of_vertices() == before) return crossing({v->info(), id});
      v->info() = id;
      hint = v->face();
      handles_.push_back(v);
    }
    return {};
  }

  Result<void> insert_edges(const std::vector<IndexPair>& edges) {
    for (const IndexPair& e : edges) {
      const VertexHandle a = handle(e[0]);
      const VertexHandle b = handle(e[1]);
      try {
        cdt_.insert_constraint(a, b);
      } catch (const Cdt::Intersection_of_constraints_exception&) {
        return crossing(e);
      }
      FaceHandle face;
      int index = 0;
      if (!cdt_.is_edge(a, b, face, index)) return crossing(e);
    }
    return {};
  }

  // Numbers the components that `crossable` constrained edges do not separate.
  template <class Component, class Crossable>
  std::int32_t flood(Component component, Crossable crossable) {
    std::int32_t count = 0;
    std::vector<FaceHandle> stack;
    const auto fill = [&](FaceHandle seed) {
      component(seed) = count;
      stack.push_back(seed);
      while (!stack.empty()) {
        const FaceHandle face = stack.back();
        stack.pop_back();
        for (int i = 0; i < 3; ++i) {
          const FaceHandle other = face->neighbor(i);
          if (component(other) >= 0) continue;
          if (face->is_constrained(i) && !crossable(face, i)) continue;
          component(other) = count;
          stack.push_back(other);
        }
      }
      ++count;
    };
    fill(cdt_.infinite_face());
    for (auto f = cdt_.all_faces_begin(); f != cdt_.all_faces_end(); ++f) {
      if (component(f) < 0) fill(f);
    }
    return count;
  }

  // Per enclosure whether it belongs to the facet; enclosure 0 is that of the infinite face.
  std::vector<std::uint8_t> find_enclosures() {
    std::vector<IndexPair> cuts = graph_.cuts;
    for (IndexPair& e : cuts) std::sort(e.begin(), e.end());
    std::sort(cuts.begin(), cuts.end());
    const auto is_cut = [&](FaceHandle f, int i) {
      IndexPair e{f->vertex(Cdt::ccw(i))->info(), f->vertex(Cdt::cw(i))->info()};
      std::sort(e.begin(), e.end());
      return std::binary_search(cuts.begin(), cuts.end(), e);
    };
    const std::int32_t count =
        flood([](FaceHandle f) -> std::int32_t& { return f->info().enclosure; }, is_cut);
    std::vector<std::uint8_t> inside(static_cast<std::size_t>(count), 1);
    inside[0] = 0;
    for (const Point3& hole : graph_.holes) {
      const FaceHandle f = cdt_.locate(plane_point(hole));
      const std::int32_t c = f == FaceHandle() ? 0 : f->info().enclosure;
      result_.hole_enclosed.push_back(c == 0 ? 0 : 1);
      inside[static_cast<std::size_t>(c)] = 0;
    }
    return inside;
  }

  FacetTriangles collect() {
    const std::vector<std::uint8_t> inside = find_enclosures();
    const auto is_inside = [&](FaceHandle f) {
      return inside[static_cast<std::size_t>(f->info().enclosure)];
    };
    const std::int32_t count = flood([](FaceHandle f) -> std::int32_t& { return f->info().piece; },
                                     [](FaceHandle, int) { return false; });
    std::vector<std::int32_t> number(static_cast<std::size_t>(count), -1);
    for (auto f = cdt_.finite_faces_begin(); f != cdt_.finite_faces_end(); ++f) {
      if (is_inside(f) == 0) continue;
      std::int32_t& piece = number[static_cast<std::size_t>(f->info().piece)];
      if (piece < 0) piece = result_.piece_count++;
      result_.triangles.push_back(
          {f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
      result_.piece.push_back(piece);
    }
    const auto count_sides = [&](const std::vector<IndexPair>& edges,
                                 std::vector<std::uint8_t>& sides) {
      for (const IndexPair& e : edges) {
        FaceHandle face;
        int index = 0;
        cdt_.is_edge(handle(e[0]), handle(e[1]), face, index);
        sides.push_back(
            static_cast<std::uint8_t>(is_inside(face) + is_inside(face->neighbor(index))));
      }
    };
    count_sides(graph_.segments, result_.segment_sides);
    count_sides(graph_.cuts, result_.cut_sides);
    return std::move(result_);
  }

  [[nodiscard]] Cdt::Point plane_point(Point3 p) const {
    const Point2 q = project_along(graph_.normal, p);
    return {q.x, q.y};
  }
  [[nodiscard]] VertexHandle handle(std::int32_t id) const {
    const auto it = std::lower_bound(ids_.begin(), ids_.end(), id);
    return handles_[static_cast<std::size_t>(it - ids_.begin())];
  }

  std::span<const Point3> points_;
  const FacetGraph& graph_;
  Cdt cdt_;
  std::vector<std::int32_t> ids_;  // sorted
  std::vector<VertexHandle> handles_;
  FacetTriangles result_;
};

}  // namespace

Point2 project_along(Point3 normal, Point3 p) {
  const double ax = std::abs(normal.x), ay = std::abs(normal.y), az = std::abs(normal.z);
  if (az >= ax && az >= ay) return normal.z > 0 ? Point2{p.x, p.y} : Point2{p.y, p.x};
  if (ay >= ax) return normal.y > 0 ? Point2{p.z, p.x} : Point2{p.x, p.z};
  return normal.x > 0 ? Point2{p.y, p.z} : Point2{p.z, p.y};
}

Result<FacetTriangles> triangulate_facet(std::span<const Point3> points, const FacetGraph& graph) {
  return Triangulator(points, graph).run();
}

}  // namespace symcell
