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

class PlcSource final : public SectorSource {
 public:
  explicit PlcSource(SymmetricPlc plc) : plc_(std::move(plc)), angles_(cut_angles(plc_)) {}

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

 private:
  SymmetricPlc plc_;
  std::vector<double> angles_;
  std::vector<std::string> repairs_;
};

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
  plc->symmetry.fold_detected = !options.fold;
  plc->symmetry.axis_detected = !(options.axis_origin && options.axis_direction);
  return plc;
}

}  // namespace

Result<std::unique_ptr<SectorSource>> symmetrise_plc(const Plc& plc,
                                                     const MeshOptions& options,
                                                     ExecutionContext& context) {
  auto valid = validate_plc(plc, context);
  if (!valid) return error_of(valid);
  auto symmetric = find_and_average(*valid, options, nullptr, context);
  if (!symmetric) return error_of(symmetric);
  return std::make_unique<PlcSource>(std::move(*symmetric));
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
  for (const PlcFit& fit : ladder) {
    result.folds.push_back({fit.fold, fit.error / valid->complex.diameter, fit.accepted});
  }
  return result;
}

}  // namespace symcell::solid
