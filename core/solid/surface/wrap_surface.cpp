#include "core/solid/surface/wrap_surface.hpp"

#include <CGAL/Alpha_wrap_3/internal/Alpha_wrap_3.h>
#include <CGAL/Alpha_wrap_3/internal/Triangle_soup_oracle.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <exception>
#include <new>
#include <utility>
#include <vector>

namespace symcell::solid {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace wraps = CGAL::Alpha_wraps_3::internal;

constexpr std::uint64_t kCheckEvery = 256;  // facets

struct Stopped {
  Error error;
};

// Ends the wrapping when the context is exhausted: the library offers no other way.
class Watch : public wraps::Wrapping_default_visitor {
 public:
  explicit Watch(ExecutionContext& context) : context_(&context) {}

  template <class Wrapper, class Gate>
  void before_facet_treatment(const Wrapper& /*wrapper*/, const Gate& /*gate*/) {
    if (++facets_ % kCheckEvery != 0) return;
    const Result<void> state = context_->check();
    if (!state) throw Stopped{state.error()};
  }

 private:
  ExecutionContext* context_;
  std::uint64_t facets_ = 0;
};

IndexedSurface indexed(const Mesh& mesh) {
  IndexedSurface result;
  for (const Mesh::Vertex_index v : mesh.vertices()) {
    const Kernel::Point_3& p = mesh.point(v);
    result.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const Mesh::Face_index f : mesh.faces()) {
    Triangle t{};
    std::size_t i = 0;
    for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f))) {
      t[i++] = static_cast<std::int32_t>(v.idx());
    }
    result.triangles.push_back(t);
    result.source.push_back(-1);
  }
  return result;
}

}  // namespace

Result<IndexedSurface> wrap_surface(const IndexedSurface& surface,
                                    double alpha,
                                    double offset,
                                    ExecutionContext& context) {
  std::vector<Kernel::Point_3> points;
  points.reserve(surface.points.size());
  for (const Point3& p : surface.points) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> faces;
  faces.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles) {
    // The library's tree takes no triangles without area.
    if (CGAL::collinear(points[t[0]], points[t[1]], points[t[2]])) continue;
    faces.push_back({static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                     static_cast<std::size_t>(t[2])});
  }
  Mesh mesh;
  try {
    using Oracle = wraps::Triangle_soup_oracle<Kernel>;
    Oracle oracle(alpha);
    oracle.add_triangle_soup(points, faces);
    wraps::Alpha_wrap_3<Oracle> wrap(oracle);
    Watch watch(context);
    wrap(alpha, offset, mesh, CGAL::parameters::visitor(std::ref(watch)));
    mesh.collect_garbage();
    if (mesh.number_of_faces() > 0 && CGAL::is_closed(mesh) && CGAL::is_triangle_mesh(mesh)) {
      return indexed(mesh);
    }
  } catch (const Stopped& stopped) {
    return fail(stopped.error);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    // Told below.
  }
  return fail(ErrorCode::kSelfIntersection, "the triangles could not be wrapped");
}

}  // namespace symcell::solid
