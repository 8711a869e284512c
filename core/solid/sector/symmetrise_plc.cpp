// `symmetrise_plc`: a validated PLC, its symmetry, and the sectors cut from it.
#include <cmath>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/assert.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/solid/plc/validate_plc.hpp"
#include "core/solid/sector/plc_sector.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "core/solid/sizes/size_sources.hpp"
#include "core/solid/sizes/wall_sizes.hpp"
#include "core/solid/symmetry/plc_symmetry.hpp"
#include "core/solid/symmetry/symmetric_plc.hpp"

namespace symcell::solid {
namespace {

Result<SymmetricPlc> find_and_average(const ValidPlc& valid,
                                      const MeshOptions& options,
                                      std::vector<PlcFit>* ladder,
                                      ExecutionContext& context) {
  const PlcComplex& complex = valid.complex;
  auto fit = find_plc_symmetry(complex, valid.cells, options, ladder, context);
  if (!fit) return error_of(fit);
  auto plc = make_symmetric_plc(complex, *fit, options.ignore_markers, context);
  if (!plc) return plc;
  plc->volume = valid.cells.volume;
  plc->symmetry.warnings = fit->warnings;
  plc->symmetry.fold_detected = !options.fold;
  plc->symmetry.axis_detected = !(options.axis_origin && options.axis_direction);
  return plc;
}

bool can_be_averaged(const ValidPlc& valid,
                     const PlcFit& fit,
                     const MeshOptions& options,
                     ExecutionContext& context) {
  return make_symmetric_plc(valid.complex, fit, options.ignore_markers, context).has_value();
}

class PlcSource final : public SectorSource {
 public:
  PlcSource(std::shared_ptr<const ValidPlc> valid, MeshOptions options, SymmetricPlc plc)
      : valid_(std::move(valid)),
        options_(std::move(options)),
        plc_(std::move(plc)),
        angles_(cut_angles(plc_)) {}

  [[nodiscard]] const Symmetry& symmetry() const override { return plc_.symmetry; }
  [[nodiscard]] const std::vector<std::string>& repairs() const override { return repairs_; }
  [[nodiscard]] std::int32_t candidates() const override {
    return static_cast<std::int32_t>(angles_.size());
  }
  [[nodiscard]] Result<Sector> sector(std::int32_t index,
                                      ExecutionContext& context) const override {
    SYMCELL_ASSERT(index >= 0 && index < candidates());
    return cut_sector(plc_, angles_[static_cast<std::size_t>(index)], context);
  }

  [[nodiscard]] Result<std::unique_ptr<SectorSource>> with_fold(
      std::int32_t fold, ExecutionContext& context) const override {
    MeshOptions options = options_;
    options.fold = fold;
    options.axis_origin = plc_.symmetry.frame.origin;
    options.axis_direction = plc_.symmetry.frame.direction();
    auto plc = find_and_average(*valid_, options, nullptr, context);
    if (!plc) return error_of(plc);
    plc->symmetry.warnings = plc_.symmetry.warnings;
    plc->symmetry.fold_detected = plc_.symmetry.fold_detected;
    plc->symmetry.axis_detected = plc_.symmetry.axis_detected;
    auto other = std::make_unique<PlcSource>(valid_, options_, std::move(*plc));
    other->size_sources_ = size_sources_;
    other->make_size_field();
    return other;
  }

  [[nodiscard]] std::shared_ptr<const SizeField> size_field() const override { return sizes_; }

  // What the options ask for of sizes, and the presets.  `vertices`: as given.
  // Errors: kBadOption (a marker or region that there is none of), limits.
  Result<void> find_sizes(std::span<const Point3> vertices, ExecutionContext& context) {
    if (options_.sizes.empty() && options_.preset == Preset::kNone) return {};
    std::vector<std::int32_t> markers;
    const IndexedSurface whole = facets_of(plc_.complex, markers);
    auto asked =
        size_sources({whole, markers, {}, attributes(), vertices, plc_.symmetry.frame}, options_);
    if (!asked) return error_of(asked);
    size_sources_ = std::move(asked->sources);
    std::vector<Warning>& warnings = plc_.symmetry.warnings;
    warnings.insert(warnings.end(), asked->warnings.begin(), asked->warnings.end());
    if (options_.preset != Preset::kNone) {
      const TriangleTree tree(whole.points, whole.triangles);
      const auto walls = wall_sizes(whole, tree, elements_across(options_.preset), true, context);
      if (!walls) return error_of(walls);
      size_sources_.insert(size_sources_.end(), walls->begin(), walls->end());
    }
    make_size_field();
    return {};
  }

 private:
  // The triangles of all facets, and their markers.
  static IndexedSurface facets_of(const PlcComplex& complex, std::vector<std::int32_t>& markers) {
    IndexedSurface whole{complex.points, {}, {}};
    for (const ComplexFacet& f : complex.facets) {
      const auto& own = f.triangles.triangles;
      whole.triangles.insert(whole.triangles.end(), own.begin(), own.end());
      markers.resize(whole.triangles.size(), f.marker);
    }
    return whole;
  }

  // Of the material, ascending; 0 of what no seed is in.
  [[nodiscard]] std::vector<std::int32_t> attributes() const {
    std::set<std::int32_t> found;
    for (const PlcCell& cell : valid_->cells.cells) {
      if (!cell.meshed) continue;
      found.insert(cell.region < 0
                       ? 0
                       : valid_->complex.regions[static_cast<std::size_t>(cell.region)].attribute);
    }
    return {found.begin(), found.end()};
  }

  void make_size_field() {
    if (size_sources_.empty()) return;
    const double gradation =
        std::isfinite(options_.gradation) ? options_.gradation : kStandardGradation;
    const std::int32_t fold = plc_.symmetry.fold;
    // Without markers in the symmetry they may differ between copies.
    const auto sources =
        options_.ignore_markers ? size_sources_ : of_first_sector(size_sources_, fold);
    sizes_ = std::make_shared<const SizeField>(sources, gradation, fold);
  }

  std::vector<SizeSource> size_sources_;
  std::shared_ptr<const SizeField> sizes_;
  std::shared_ptr<const ValidPlc> valid_;
  MeshOptions options_;  // as given
  SymmetricPlc plc_;
  std::vector<double> angles_;
  std::vector<std::string> repairs_;
};

}  // namespace

Result<std::unique_ptr<SectorSource>> symmetrise_plc(const Plc& plc,
                                                     const MeshOptions& options,
                                                     ExecutionContext& context) {
  auto valid = validate_plc(plc, context);
  if (!valid) return error_of(valid);
  auto shared = std::make_shared<const ValidPlc>(std::move(*valid));
  auto symmetric = find_and_average(*shared, options, nullptr, context);
  if (!symmetric) return error_of(symmetric);
  auto source = std::make_unique<PlcSource>(std::move(shared), options, std::move(*symmetric));
  SYMCELL_TRY(source->find_sizes(plc.vertices, context));
  return source;
}

Result<SolidInspection> inspect_plc(const Plc& plc,
                                    const MeshOptions& options,
                                    ExecutionContext& context) {
  auto valid = validate_plc(plc, context);
  if (!valid) return error_of(valid);
  std::vector<PlcFit> ladder;
  const auto symmetric = find_and_average(*valid, options, &ladder, context);
  if (!symmetric) return error_of(symmetric);
  SolidInspection result;
  result.kind = "plc";
  result.fold = symmetric->symmetry.fold;
  result.axis_origin = symmetric->symmetry.frame.origin;
  result.axis_direction = symmetric->symmetry.frame.direction();
  result.symmetry_error_rel = symmetric->symmetry.error_rel;
  result.diameter = valid->complex.diameter;
  result.bbox_min = valid->complex.box_low;
  result.bbox_max = valid->complex.box_high;
  result.vertices = plc.vertices.size();
  result.facets = plc.facets.size();
  result.volume = valid->cells.volume;
  result.holes = plc.holes.size();
  result.regions = plc.regions.size();
  result.warnings = symmetric->symmetry.warnings;
  for (const PlcFit& fit : ladder) {
    const bool accepted = fit.accepted && (result.fold % fit.fold == 0 ||
                                           can_be_averaged(*valid, fit, options, context));
    FoldCandidate rung{fit.fold, fit.error / valid->complex.diameter, accepted};
    if (fit.worst_vertex >= 0) {
      rung.worst = valid->complex.points[static_cast<std::size_t>(fit.worst_vertex)];
    }
    result.folds.push_back(rung);
  }
  return result;
}

}  // namespace symcell::solid
