// `symmetrise_plc`: a validated PLC, its symmetry, and the sectors cut from it.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/assert.hpp"
#include "core/solid/plc/validate_plc.hpp"
#include "core/solid/sector/plc_sector.hpp"
#include "core/solid/sector/symmetrise.hpp"
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
    return std::make_unique<PlcSource>(valid_, options_, std::move(*plc));
  }

 private:
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
  return std::make_unique<PlcSource>(std::move(shared), options, std::move(*symmetric));
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
