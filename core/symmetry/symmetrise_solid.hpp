// From a solid model and the user's fold, axis and tolerance to a source of exact sectors, and what
// `symcell inspect` tells of a solid.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/plc.hpp"
#include "core/model/triangle_surface.hpp"
#include "core/symmetry/sector_source.hpp"
#include "core/symmetry/symmetrise.hpp"

namespace symcell {

// Validates the PLC, finds or checks fold and axis (vertices, facets, segments, seeds and, unless
// ignore_markers, markers and attributes must map onto each other), averages every orbit.
// Errors: model codes, kBadFold, kBadAxis, kNotSymmetric (names fold, error, tolerance and the
// worst vertex), limits.
[[nodiscard]] Result<std::unique_ptr<SectorSource>> symmetrise_plc(const Plc& plc,
                                                                   const MeshOptions& options,
                                                                   ExecutionContext& context);

// Cleans the surface, finds or checks fold and axis on the geometry (not on matching vertices).
// Errors: kNotWatertight, kSelfIntersection (both name triangles and coordinates), kNonFinite,
// kDegenerateGeometry, kBadFold, kBadAxis, kNotSymmetric, kAmbiguousSymmetry, limits.
[[nodiscard]] Result<std::unique_ptr<SectorSource>> symmetrise_surface(
    const TriangleSurface& surface, const MeshOptions& options, ExecutionContext& context);

struct SolidInspection {
  std::string kind;  // "plc" or "surface"
  std::int32_t fold = 1;
  Point3 axis_origin;
  Point3 axis_direction{0, 0, 1};
  double symmetry_error_rel = 0;
  double volume = 0;        // of the meshed domain (PLC: 0 if it cannot be told without meshing)
  double surface_area = 0;  // surfaces only
  double diameter = 0;
  Point3 bbox_min;
  Point3 bbox_max;
  bool watertight = true;
  std::size_t vertices = 0;
  std::size_t facets = 0;  // facets of a PLC, triangles of a surface, after cleaning
  std::size_t shells = 0;  // surfaces: closed components
  std::size_t holes = 0;
  std::size_t regions = 0;
  std::vector<std::string> repairs;
  std::vector<FoldCandidate> folds;  // the ladder, ascending
  // Not empty: why a mesh of this model would be refused (open, self-intersecting, ambiguous).
  std::string problem;
};

[[nodiscard]] Result<SolidInspection> inspect_plc(const Plc& plc,
                                                  const MeshOptions& options,
                                                  ExecutionContext& context);
[[nodiscard]] Result<SolidInspection> inspect_surface(const TriangleSurface& surface,
                                                      const MeshOptions& options,
                                                      ExecutionContext& context);

}  // namespace symcell
