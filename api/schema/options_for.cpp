// Whether options fit a kind of model, checked once the kind is known.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "api/schema/options.hpp"

namespace symcell {
namespace {

Failure not_of_kind(ModelKind kind, const std::string& name) {
  const std::string message =
      is_planar(kind)
          ? " is for solid models; planar models take min_angle, max_area, max_edge and min_edge"
          : " is for planar models; solids take radius_edge, min_dihedral, max_volume, "
            "max_edge, min_edge, sizes and gradation";
  return fail(ErrorCode::kBadOption, name + message, {}, "/options/" + name);
}

Failure repair_is_for_surfaces() {
  return fail(
      ErrorCode::kBadOption,
      "repair is for tessellated surfaces (STL, OFF, PLY, OBJ) and planar models; nothing is "
      "mended in a PLC",
      {}, "/options/repair");
}

Failure bad_axis(const std::string& name, const std::string& message) {
  return fail(ErrorCode::kBadAxis, message, {}, "/options/" + name);
}

// Dividing an edge that is too long makes halves of it.
Result<void> check_edge_lengths(const MeshOptions& options) {
  double longest = options.max_edge;
  for (const SizeRequest& s : options.sizes) longest = std::min(longest, s.size);
  if (options.min_edge <= 0.5 * longest) return {};
  return fail(
      ErrorCode::kBadOption,
      "min_edge must be at most half of max_edge and of each of the sizes: edges that are too "
      "long are divided in two",
      {}, "/options/min_edge");
}

Result<MeshOptions> options_for_planar(MeshOptions options) {
  const MeshOptions standard;
  const auto refuse = [](const char* name) { return not_of_kind(ModelKind::kPslg, name); };
  if (options.radius_edge != standard.radius_edge) return refuse("radius_edge");
  if (options.min_dihedral_deg != standard.min_dihedral_deg) return refuse("min_dihedral");
  if (std::isfinite(options.max_volume)) return refuse("max_volume");
  if (options.delaunay) return refuse("delaunay");
  if (options.curved) return refuse("curved");
  if (options.feature_angle_deg) return refuse("feature_angle");
  if (options.preset != Preset::kNone) return refuse("preset");
  for (const SizeRequest& s : options.sizes) {
    if (s.kind != SizeRequest::Kind::kRegion && s.kind != SizeRequest::Kind::kPoint) continue;
    return fail(
        ErrorCode::kBadOption,
        "sizes of planar models are of markers, their names and vertices; sizes of regions and "
        "points are for solids (a region may have a max_area)",
        {}, "/options/sizes");
  }
  if (options.repair == Repair::kWrap) {
    return fail(
        ErrorCode::kBadOption,
        "repair of a planar model is none, safe (loose ends are joined) or all; wrap is for "
        "tessellated surfaces",
        {}, "/options/repair");
  }
  if (options.axis_direction &&
      (options.axis_direction->x != 0 || options.axis_direction->y != 0)) {
    return bad_axis("axis_direction",
                    "axis_direction must be 0,0,1 or left out for a planar model: its axis is "
                    "normal to the plane");
  }
  if (options.axis_origin) {
    const Point2 center{options.axis_origin->x, options.axis_origin->y};
    if (options.axis_origin->z != 0) {
      return bad_axis("axis_origin", "axis_origin must lie in the plane z = 0 of a planar model");
    }
    if (options.center && *options.center != center) {
      return bad_axis("axis_origin",
                      "center and axis_origin are two different points; give one of them");
    }
    options.center = center;
  }
  SYMCELL_TRY(check_edge_lengths(options));
  options.axis_origin.reset();
  options.axis_direction.reset();
  return options;
}

Result<MeshOptions> options_for_solid(ModelKind kind, MeshOptions options) {
  const MeshOptions standard;
  if (options.center) {
    return bad_axis("center",
                    "a planar centre of two coordinates was given, but the model is a solid; give "
                    "axis_origin x,y,z and axis_direction x,y,z");
  }
  if (kind != ModelKind::kSurface && options.repair != standard.repair) {
    return repair_is_for_surfaces();
  }
  if (kind == ModelKind::kPlc && options.feature_angle_deg) {
    return fail(
        ErrorCode::kBadOption,
        "feature_angle is for tessellated surfaces (STL, OFF, PLY, OBJ); the facets of a PLC have "
        "their markers",
        {}, "/options/feature_angle");
  }
  if (kind == ModelKind::kPlc && options.curved) {
    return fail(
        ErrorCode::kBadOption,
        "curved is for tessellated surfaces (STEP, IGES, STL, OFF, PLY, OBJ); the facets of "
        "a PLC are plane",
        {}, "/options/curved");
  }
  if (options.min_angle_deg != standard.min_angle_deg) return not_of_kind(kind, "min_angle");
  if (std::isfinite(options.max_area)) return not_of_kind(kind, "max_area");
  if (!options.divisions.empty()) return not_of_kind(kind, "divisions");
  if (options.keep_boundary) return not_of_kind(kind, "keep_boundary");
  if (options.sector && kind == ModelKind::kPlc) {
    return fail(
        ErrorCode::kBadOption,
        "sector is for planar models and tessellated surfaces; give the sector's surface as "
        "STL, OFF, PLY or OBJ",
        {}, "/options/sector");
  }
  if (options.chord_error_given && kind == ModelKind::kPlc) {
    return fail(
        ErrorCode::kBadOption,
        "chord_error is for arcs of planar models and for curved faces of tessellated surfaces; "
        "the facets of a PLC are plane",
        {}, "/options/chord_error");
  }
  SYMCELL_TRY(check_edge_lengths(options));
  return options;
}

}  // namespace

Result<MeshOptions> options_for(ModelKind kind, MeshOptions options) {
  return is_planar(kind) ? options_for_planar(std::move(options))
                         : options_for_solid(kind, std::move(options));
}

}  // namespace symcell
