// The CDT of the whole symmetric model (all copies), with faces classified. Internal to initial/:
// the only header there that includes CGAL.
#pragma once

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/plane/symmetry/symmetric_pslg.hpp"

namespace symcell::plane::initial {

struct FaceInfo {
  std::int32_t subdomain = -1;  // index of FullCdt::subdomains
  std::int32_t merged = -1;     // index of a merged face (initial_triangulation.cpp)
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<OrbitVertex, Kernel>;
using ConstrainedFaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel, ConstrainedFaceBase>;
using Tds = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    Tds,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

struct Subdomain {
  bool inside = true;  // of the domain: bounded and without hole seed
  bool has_region = false;
  std::int32_t attribute = 0;
  double max_area = std::numeric_limits<double>::infinity();
};

struct FullCdt {
  Cdt cdt;
  std::vector<Subdomain> subdomains;
  std::int32_t centre_orbit = -1;  // -1 for fold 1 without a centre vertex
  std::int32_t orbit_count = 0;
};

// Errors: as triangulate_initial.
[[nodiscard]] Result<void> build_full_cdt(const SymmetricPslg& pslg,
                                          ExecutionContext& context,
                                          FullCdt& full);

}  // namespace symcell::plane::initial
