// From a solid model and the user's fold, axis and tolerance to a source of exact sectors, and what
// `symcell inspect` reports of a solid.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/inspection.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/plc.hpp"
#include "core/model/triangle_surface.hpp"
#include "core/solid/sector/sector_source.hpp"

namespace symcell::solid {

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

[[nodiscard]] Result<SolidInspection> inspect_plc(const Plc& plc,
                                                  const MeshOptions& options,
                                                  ExecutionContext& context);
[[nodiscard]] Result<SolidInspection> inspect_surface(const TriangleSurface& surface,
                                                      const MeshOptions& options,
                                                      ExecutionContext& context);

}  // namespace symcell::solid
