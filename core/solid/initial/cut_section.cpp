#include "core/solid/initial/cut_section.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/index.hpp"

namespace symcell::solid::initial {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using ConstrainedFaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
// Info of a face: reached from infinity.
using FaceBase = CGAL::Triangulation_face_base_with_info_2<bool, Kernel, ConstrainedFaceBase>;
using Tds = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    Tds,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

Failure failed(const std::string& why) {
  return fail(ErrorCode::kTetrahedralizationFailed, "section of the solid with the cut: " + why);
}

// The vertices on the axis and those whose orbit has one on the higher cut as well.
std::vector<std::int32_t> images_of(const Sector& sector) {
  std::vector<std::int32_t> higher(sector.orbit_points.size(), -1);
  for (std::size_t v = 0; v < sector.vertices.size(); ++v) {
    const OrbitVertex o = sector.vertices[v];
    if (o.exponent == 1 || sector.on_axis[at(o.orbit)] != 0) {
      higher[at(o.orbit)] = static_cast<std::int32_t>(v);
    }
  }
  std::vector<std::int32_t> image(sector.vertices.size(), -1);
  for (std::size_t v = 0; v < sector.vertices.size(); ++v) {
    if (sector.vertices[v].exponent == 0) image[v] = higher[at(sector.vertices[v].orbit)];
  }
  return image;
}

class SectionTriangulation {
 public:
  explicit SectionTriangulation(const Sector& sector)
      : sector_(sector), handles_(sector.vertices.size()) {}

  Result<void> insert(const std::vector<std::int32_t>& image) {
    std::vector<std::int32_t> axis;
    std::size_t count = 0;
    for (std::size_t v = 0; v < image.size(); ++v) {
      if (image[v] < 0) continue;
      const std::int32_t orbit = sector_.vertices[v].orbit;
      const Point3 p = sector_.orbit_points[at(orbit)];
      const Cdt::Vertex_handle h = cdt_.insert(Cdt::Point(std::hypot(p.x, p.y), p.z));
      h->info() = static_cast<std::int32_t>(v);
      handles_[v] = h;
      ++count;
      if (sector_.on_axis[at(orbit)] != 0) axis.push_back(static_cast<std::int32_t>(v));
    }
    if (cdt_.number_of_vertices() != count) return failed("two of its vertices coincide");
    for (const auto& [a, b] : sector_.lower_cut) {
      if (image[at(a)] < 0 || image[at(b)] < 0) {
        return failed("vertex " + std::to_string(image[at(a)] < 0 ? a : b) + " has no image");
      }
      SYMCELL_TRY(insert_constraint(a, b));
    }
    std::sort(axis.begin(), axis.end(),
              [&](std::int32_t a, std::int32_t b) { return height(a) < height(b); });
    for (std::size_t i = 0; i + 1 < axis.size(); ++i) {
      SYMCELL_TRY(insert_constraint(axis[i], axis[i + 1]));
    }
    return {};
  }

  // Faces that cannot be reached from infinity.
  std::vector<std::array<std::int32_t, 3>> enclosed_faces() {
    std::vector<std::array<std::int32_t, 3>> faces;
    if (cdt_.dimension() < 2) return faces;
    for (const Cdt::Face_handle f : cdt_.all_face_handles()) f->info() = false;
    std::vector<Cdt::Face_handle> stack{cdt_.infinite_face()};
    stack.back()->info() = true;
    while (!stack.empty()) {
      const Cdt::Face_handle face = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const Cdt::Face_handle other = face->neighbor(i);
        if (face->is_constrained(i) || other->info()) continue;
        other->info() = true;
        stack.push_back(other);
      }
    }
    for (const Cdt::Face_handle f : cdt_.finite_face_handles()) {
      if (f->info()) continue;
      faces.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
    }
    return faces;
  }

 private:
  [[nodiscard]] double height(std::int32_t v) const {
    return sector_.orbit_points[at(sector_.vertices[at(v)].orbit)].z;
  }

  Result<void> insert_constraint(std::int32_t a, std::int32_t b) {
    const Cdt::Vertex_handle from = handles_[at(a)], to = handles_[at(b)];
    cdt_.insert_constraint(from, to);
    Cdt::Face_handle face;
    int index = 0;
    if (cdt_.is_edge(from, to, face, index)) return {};
    return failed("a vertex lies inside the edge between sector vertices " + std::to_string(a) +
                  " and " + std::to_string(b));
  }

  const Sector& sector_;
  Cdt cdt_;
  std::vector<Cdt::Vertex_handle> handles_;
};

}  // namespace

Result<CutSection> make_cut_section(const Sector& sector) {
  CutSection section;
  if (sector.fold == 1) {
    section.image.assign(sector.vertices.size(), -1);
    return section;
  }
  section.image = images_of(sector);
  try {
    SectionTriangulation triangulation(sector);
    SYMCELL_TRY(triangulation.insert(section.image));
    section.faces = triangulation.enclosed_faces();
  } catch (const std::exception&) {
    return failed("its curves cross");
  }
  return section;
}

}  // namespace symcell::solid::initial
