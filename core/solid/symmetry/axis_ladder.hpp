// The folds that a surface has about one axis, or nearly has.
//
// See detect_surface_symmetry.hpp for the rules by which a fold counts.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/inspection.hpp"
#include "core/solid/symmetry/shape_symmetry.hpp"

namespace symcell::solid {

struct AxisLadder {
  SymmetryAxis axis;  // refined, for `fold` or for what fits best
  std::int32_t fold = 1;
  double error = 0;         // of `fold`, input units
  bool revolution = false;  // every angle fits, and no fold better than others
  // So many folds fit at a first look that the shape is nearly one of revolution.
  bool many = false;
  std::vector<FoldCandidate> folds;  // ascending
  // Errors of turns, by numerator and denominator, exact up to the bound they were measured with.
  std::map<std::pair<std::int32_t, std::int32_t>, ShapeError> turns;
};

class AxisLadders {
 public:
  // What of an axis is known already and is not to be refined.
  struct Fixed {
    bool origin = false;
    bool direction = false;
  };

  // All by reference but `fixed`.  `diameter`: of the surface.
  AxisLadders(const ShapeSymmetry& shape, double diameter, Fixed fixed, ExecutionContext& context)
      : shape_(shape), diameter_(diameter), fixed_(fixed), context_(context) {}

  // The fold about an axis, refined.  `folds` holds what was measured for it.
  // `tolerance`: input units.  Errors: limits.
  [[nodiscard]] Result<AxisLadder> climb(const SymmetryAxis& candidate, double tolerance) const;

  // Leaves in `ladder.folds`, made by climb, the folds within ten tolerances, up to kMostNearFold
  // beyond the first tolerance, with their exact errors; refines the axis for those that might
  // count. A fold that fits after all is taken.  Errors: limits.
  [[nodiscard]] Result<void> widen(const SymmetryAxis& candidate,
                                   double tolerance,
                                   AxisLadder& ladder) const;

  // Whether the fold would be the one found with this tolerance.  `error`: about the best axis,
  // input units.  Errors: limits.
  [[nodiscard]] Result<bool> takes(const SymmetryAxis& candidate,
                                   std::int32_t fold,
                                   double error,
                                   double tolerance) const;

  // The axis for which a fold fits best.
  [[nodiscard]] SymmetryAxis refined(const SymmetryAxis& axis,
                                     std::int32_t fold,
                                     double tolerance) const;

  // Of a surface that nearly any angle fits: the axis about which it does, and the largest distance
  // that was found.  Errors: limits.
  struct Revolution {
    SymmetryAxis axis;
    double error = 0;  // input units; infinite: above `enough`
  };
  [[nodiscard]] Result<Revolution> revolution(const SymmetryAxis& candidate,
                                              double tolerance,
                                              double enough) const;

 private:
  // By which turn of a fold axes are compared and refined.
  enum class Turn : std::uint8_t {
    kOne,  // by one sector
    kOdd,  // by sectors that come near an odd angle
  };
  [[nodiscard]] Result<AxisLadder> climb_by(Turn turn,
                                            const SymmetryAxis& candidate,
                                            double tolerance) const;
  [[nodiscard]] SymmetryAxis refined_by(double angle,
                                        const SymmetryAxis& axis,
                                        double tolerance) const;
  [[nodiscard]] SymmetryAxis nicer(const SymmetryAxis& axis, double angle, double tolerance) const;
  [[nodiscard]] std::int32_t leader(Turn turn,
                                    const SymmetryAxis& candidate,
                                    const std::vector<std::int32_t>& folds,
                                    double cap) const;
  [[nodiscard]] std::vector<std::int32_t> quick_folds(const SymmetryAxis& axis,
                                                      double reach,
                                                      std::int32_t last) const;
  [[nodiscard]] std::int32_t misfitting_turn(const SymmetryAxis& axis,
                                             std::int32_t n,
                                             double reach) const;
  [[nodiscard]] bool fits_odd_angles(const SymmetryAxis& axis, double reach) const;
  [[nodiscard]] std::vector<std::int32_t> outstanding(const SymmetryAxis& axis,
                                                      const std::vector<std::int32_t>& folds,
                                                      double cap) const;
  [[nodiscard]] Result<ShapeError> measure(AxisLadder& ladder,
                                           std::int32_t n,
                                           std::int32_t first,
                                           std::int32_t last,
                                           double enough) const;
  [[nodiscard]] std::vector<std::int32_t> near_folds(const AxisLadder& ladder,
                                                     double tolerance,
                                                     double reach) const;
  void judge(AxisLadder& ladder, double tolerance) const;

  const ShapeSymmetry& shape_;
  double diameter_;
  Fixed fixed_;
  ExecutionContext& context_;
};

}  // namespace symcell::solid
