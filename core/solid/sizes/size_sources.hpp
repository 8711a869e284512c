// What the options ask for of sizes from place to place, as sources of a size field.
#pragma once

#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/cell/warning.hpp"
#include "core/geometry/axis_frame.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"
#include "core/solid/groups/face_groups.hpp"
#include "core/solid/sizes/size_field.hpp"

namespace symcell::solid {

// What sizes are asked for on: triangles with their markers, and the names and vertices that the model has.
struct SizedModel {
  const IndexedSurface& surface;          // local frame, all copies
  std::span<const std::int32_t> markers;  // per triangle
  std::vector<MarkerName> names;          // of markers
  std::vector<std::int32_t> regions;  // attributes of the material, each once; none: it has none
  std::span<const Point3> vertices;   // as given
  AxisFrame frame;
};

struct AskedSizes {
  std::vector<SizeSource> sources;
  std::vector<Warning> warnings;  // of sizes that can change nothing
};

// Of markers, groups, vertices and points. Regions have bounds without places (Criteria).
// Errors: kBadOption (a marker or group that no facet has, a vertex or region that is none).
[[nodiscard]] Result<AskedSizes> size_sources(const SizedModel& model, const MeshOptions& options);

// Of sources that cover a face in all copies those that meet the first sector, and all points, which are
// in one copy.
[[nodiscard]] std::vector<SizeSource> of_first_sector(const std::vector<SizeSource>& sources,
                                                      std::int32_t fold);

// So long on curved faces that an edge between two points of the face is at most chord_error of its
// radius away from it. Of faces of no known kind the radius is that of their turning from triangle to
// triangle.
[[nodiscard]] std::vector<SizeSource> curvature_sources(const IndexedSurface& surface,
                                                        const FaceGroups& groups,
                                                        double chord_error_rel);

}  // namespace symcell::solid
