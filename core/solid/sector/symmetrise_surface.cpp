#include <string>
#include <utility>

#include "core/solid/sector/surface_sector_source.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "core/solid/surface/clean_surface.hpp"
#include "core/solid/surface/make_whole.hpp"
#include "core/solid/symmetry/detect_surface_symmetry.hpp"

namespace symcell::solid {
namespace {

// The surface, and where it bounds a sector that of all sectors, closed and oriented, or with its
// problem.
Result<CleanSurface> clean_whole(const TriangleSurface& surface,
                                 const MeshOptions& options,
                                 ExecutionContext& context) {
  const double tolerance_rel =
      options.symmetry_tolerance_rel.value_or(kSurfaceSymmetryToleranceRel);
  auto clean = clean_surface(surface, context, tolerance_rel, options.repair);
  if (clean && surface.cad_notes && surface.cad_notes->mended > 0) {
    clean->repairs.insert(clean->repairs.begin(),
                          std::to_string(surface.cad_notes->mended) + " invalid solids mended");
  }
  if (!clean || clean->problem || !options.sector) return clean;
  const AxisFrame axis = AxisFrame::of_axis(options.axis_origin.value_or(Point3{0, 0, 0}),
                                            options.axis_direction.value_or(Point3{0, 0, 1}));
  const auto whole =
      make_whole(clean->surface, *options.sector, axis, tolerance_rel * clean->diameter);
  if (!whole) return error_of(whole);
  auto all = clean_surface(*whole, context, tolerance_rel, options.repair);
  if (all) all->repairs.insert(all->repairs.begin(), clean->repairs.begin(), clean->repairs.end());
  return all;
}

}  // namespace

Result<std::unique_ptr<SectorSource>> symmetrise_surface(const TriangleSurface& surface,
                                                         const MeshOptions& options,
                                                         ExecutionContext& context) {
  const double tolerance_rel =
      options.symmetry_tolerance_rel.value_or(kSurfaceSymmetryToleranceRel);
  auto clean = clean_whole(surface, options, context);
  if (!clean) return error_of(clean);
  if (clean->problem) return fail(*clean->problem);
  auto symmetry = detect_surface_symmetry(*clean, options, context);
  if (!symmetry) return error_of(symmetry);
  if (surface.cad_notes) {
    const std::vector<Warning> of_file = cad_warnings(*surface.cad_notes);
    std::vector<Warning>& warnings = symmetry->symmetry.warnings;
    warnings.insert(warnings.begin(), of_file.begin(), of_file.end());
  }
  const double tolerance = tolerance_rel * clean->diameter;
  auto source =
      std::make_unique<SurfaceSectorSource>(std::move(*clean), symmetry->symmetry, tolerance);
  SYMCELL_TRY(source->find_groups(surface, options, context));
  SYMCELL_TRY(source->find_sizes(surface, options, context));
  return source;
}

Result<SolidInspection> inspect_surface(const TriangleSurface& surface,
                                        const MeshOptions& options,
                                        ExecutionContext& context) {
  const double tolerance_rel =
      options.symmetry_tolerance_rel.value_or(kSurfaceSymmetryToleranceRel);
  auto clean = clean_whole(surface, options, context);
  if (!clean) return error_of(clean);
  SolidInspection result;
  result.kind = "surface";
  result.volume = clean->volume;
  result.surface_area = clean->area;
  result.diameter = clean->diameter;
  result.bbox_min = clean->box.low;
  result.bbox_max = clean->box.high;
  result.watertight = !clean->problem || clean->problem->code != ErrorCode::kNotWatertight;
  result.vertices = clean->surface.points.size();
  result.facets = clean->surface.triangles.size();
  result.shells = static_cast<std::size_t>(clean->shells);
  result.repairs = clean->repairs;
  if (surface.cad_notes) result.warnings = cad_warnings(*surface.cad_notes);
  if (!clean->repairs.empty()) result.warnings.push_back(surface_repaired_warning(clean->repairs));
  if (clean->problem) {
    result.problem = clean->problem->message;
    result.at_fault = clean->problem->elements;
    return result;
  }
  auto found = detect_surface_symmetry(*clean, options, context);
  if (!found) {
    const ErrorCode code = found.error().code;
    if (code != ErrorCode::kAmbiguousSymmetry && code != ErrorCode::kNotSymmetric) {
      return error_of(found);
    }
    result.problem = found.error().message;
    return result;
  }
  const Symmetry& symmetry = found->symmetry;
  result.fold = symmetry.fold;
  result.axis_origin = symmetry.frame.origin;
  result.axis_direction = symmetry.frame.direction();
  result.symmetry_error_rel = symmetry.error_rel;
  result.folds = found->folds;
  result.warnings.insert(result.warnings.begin(), symmetry.warnings.begin(),
                         symmetry.warnings.end());
  auto groups = groups_of_surface(std::move(clean->surface), symmetry,
                                  tolerance_rel * result.diameter, surface, options, context);
  if (!groups) return error_of(groups);
  result.groups = std::move(*groups);
  return result;
}

}  // namespace symcell::solid
