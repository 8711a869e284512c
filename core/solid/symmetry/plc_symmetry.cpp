#include "core/solid/symmetry/plc_symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "core/cell/inspection.hpp"
#include "core/geometry/limits.hpp"
#include "core/geometry/resolution.hpp"
#include "core/model/describe.hpp"
#include "core/solid/symmetry/plc_axes.hpp"

namespace symcell::solid {
namespace {

// The largest tolerance that can be given, of the diameter.
constexpr double kMostToleranceRel = 0.1;

bool in_range(Point3 p) {
  return std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate &&
         std::abs(p.z) <= kMaxCoordinate;  // false for NaN
}

Result<void> check_options(const MeshOptions& options) {
  if (options.fold && (*options.fold < 1 || *options.fold > kMaxFold)) {
    return fail(ErrorCode::kBadFold,
                "fold " + std::to_string(*options.fold) + " is not between 1 and " +
                    std::to_string(kMaxFold) + "; give the number of equal sectors, or auto",
                {}, "/options/fold");
  }
  if (options.axis_origin && !in_range(*options.axis_origin)) {
    return fail(ErrorCode::kBadAxis,
                "the axis origin " + describe_point(*options.axis_origin) +
                    " is not finite or out of range; give finite coordinates, or leave it out",
                {}, "/options/axis_origin");
  }
  if (options.axis_direction &&
      (!in_range(*options.axis_direction) || !(length(*options.axis_direction) > 0))) {
    return fail(ErrorCode::kBadAxis,
                "the axis direction " + describe_point(*options.axis_direction) +
                    " is zero, not finite or out of range; give a vector along the axis, or leave "
                    "it out",
                {}, "/options/axis_direction");
  }
  return {};
}

std::vector<std::int32_t> divisors_above_one(std::int64_t n) {
  std::vector<std::int32_t> result;
  const std::int64_t limit = std::min<std::int64_t>(n, kMaxFold);
  for (std::int64_t d = 2; d <= limit; ++d) {
    if (n % d == 0) result.push_back(static_cast<std::int32_t>(d));
  }
  return result;
}

// Without symmetry the axis only fixes the origin: that of the model, or far from it a coarse
// multiple of a power of two near the middle, which subtracts exactly.
AxisFrame plain_frame(const PlcComplex& complex, const MeshOptions& options) {
  const Point3 middle = complex.box_low + 0.5 * (complex.box_high - complex.box_low);
  const double step = std::exp2(std::ceil(std::log2(complex.diameter)));
  const auto coarse = [step](double x) {
    return std::abs(x) < 4 * step ? 0.0 : step * std::round(x / step);
  };
  AxisFrame frame;
  frame.origin = {coarse(middle.x), coarse(middle.y), coarse(middle.z)};
  if (options.axis_origin && options.axis_direction) {
    frame = AxisFrame::of_axis(*options.axis_origin, *options.axis_direction);
  }
  return frame;
}

class SymmetrySearch {
 public:
  // All by reference.
  SymmetrySearch(const PlcComplex& complex,
                 const PlcCells& cells,
                 const MeshOptions& options,
                 ExecutionContext& context)
      : complex_(complex),
        cells_(cells),
        options_(options),
        context_(context),
        tolerance_(std::max(
            options.symmetry_tolerance_rel.value_or(kExactSymmetryToleranceRel) * complex.diameter,
            resolution_of(complex.diameter, complex.magnitude))),
        reach_(
            std::max(tolerance_,
                     std::min(kNearTolerances * tolerance_, kMostToleranceRel * complex.diameter))),
        adjust_(!(options.axis_origin && options.axis_direction)),
        matcher_(complex, cells, tolerance_, options.ignore_markers) {}

  Result<PlcFit> run(std::vector<PlcFit>* ladder) {
    if (options_.fold == 1) return without_symmetry();
    AxisCandidates axes;
    SYMCELL_TRY(search(axes));
    if (!best_.accepted && options_.fold) return not_symmetric();
    PlcFit result = best_.accepted ? best_ : without_symmetry();
    if (options_.fold && ladder == nullptr) {
      warn(result);
      return result;
    }
    const AxisCandidates wide =
        principal_axes(complex_, options_.axis_origin, options_.axis_direction, reach_);
    if (!options_.fold) {
      auto warnings = near_warnings(wide, result.fold);
      if (!warnings) return error_of(warnings);
      result.warnings = std::move(*warnings);
    }
    if (ladder != nullptr) fill_ladder(axes, wide, *ladder);
    warn(result);
    return result;
  }

  // The fold alone; 1 if there is none.
  Result<std::int32_t> found_fold() {
    AxisCandidates axes;
    SYMCELL_TRY(search(axes));
    return best_.accepted ? best_.fold : 1;
  }

 private:
  Result<void> search(AxisCandidates& axes) {
    axes = principal_axes(complex_, options_.axis_origin, options_.axis_direction, tolerance_);
    SYMCELL_TRY(try_all(axes.list));
    if (axes.isotropic || (axes.open && !best_.accepted)) {
      SYMCELL_TRY(try_all(scattered_axes(complex_, options_.axis_origin, tolerance_)));
    }
    return {};
  }

  void warn(PlcFit& result) const {
    if (!options_.fold && result.fold == 1) {
      result.warnings.push_back(no_symmetry_warning(tolerance_ / complex_.diameter));
    }
    if (ambiguous_) {
      result.warnings.push_back(
          axis_ambiguous_warning(result.fold, result.frame.origin, result.frame.direction()));
    }
  }

  [[nodiscard]] PlcFit without_symmetry() const {
    return matcher_.fit(1, plain_frame(complex_, options_), false);
  }

  // Whether a fold as large as the best one's belongs to another axis as well.
  void look_for_equal(std::int32_t fold, const AxisCandidate& axis) {
    constexpr int kMostEqual = 8;  // axes; each costs a fit
    if (fold != best_.fold || ambiguous_ || is_same_axis(axis.frame, best_.frame)) return;
    if (++equal_tried_ > kMostEqual) return;
    compare_axes(matcher_.fit(fold, axis.frame, adjust_));
  }

  void compare_axes(const PlcFit& fit) {
    ambiguous_ = ambiguous_ || (fit.accepted && best_.accepted && fit.fold == best_.fold &&
                                !is_same_axis(fit.frame, best_.frame));
  }

  static bool is_same_axis(const AxisFrame& a, const AxisFrame& b) {
    constexpr double kSameAxis = 1e-3;  // sine of the angle between them
    return length(cross(a.direction(), b.direction())) <= kSameAxis;
  }

  // Keeps the best fit: accepted before not, higher folds before lower ones, then smaller errors.
  Result<void> try_all(const std::vector<AxisCandidate>& axes) {
    for (const AxisCandidate& axis : axes) {
      SYMCELL_TRY(context_.check());
      if (options_.fold) {
        const std::int32_t fold = *options_.fold;
        // The counts leave out vertices near the axis only, so this loses no symmetric axis; the
        // first few are looked at for the error to report.
        constexpr int kReported = 6;
        if (axis.greatest_fold % fold != 0 && ++reported_ > kReported) continue;
        const PlcFit fit = matcher_.fit(fold, axis.frame, adjust_);
        compare_axes(fit);
        consider(fit, axis);
        continue;
      }
      const std::vector<std::int32_t> folds = divisors_above_one(axis.greatest_fold);
      for (auto fold = folds.rbegin(); fold != folds.rend(); ++fold) {
        if (best_.accepted && *fold <= best_.fold) {
          look_for_equal(*fold, axis);
          break;
        }
        const PlcFit fit = matcher_.fit(*fold, axis.frame, adjust_);
        consider(fit, axis);
        if (fit.accepted) break;
      }
    }
    return {};
  }

  void consider(const PlcFit& fit, const AxisCandidate& axis) {
    const auto rank = [](const PlcFit& f) {
      return std::tuple(f.accepted ? 0 : 1, f.accepted ? -f.fold : 0, f.error);
    };
    // Errors that are but rounding do not decide: the first candidate is the best one.
    const double noise = resolution_of(complex_.diameter, complex_.magnitude);
    const bool better = !found_ || (fit.accepted == best_.accepted && fit.fold == best_.fold
                                        ? fit.error + noise < best_.error
                                        : rank(fit) < rank(best_));
    if (!better) return;
    if (fit.fold != best_.fold) ambiguous_ = false;
    found_ = true;
    best_ = fit;
    best_axis_ = axis;
  }

  // Of the folds that only a larger tolerance takes, the largest; each with the smallest tolerance.
  Result<std::vector<Warning>> near_warnings(const AxisCandidates& wide, std::int32_t taken) {
    constexpr int kMostTried = 24;        // each costs a fit
    constexpr std::size_t kMostNear = 3;  // reported
    constexpr std::size_t kFewPoints = 500;
    std::vector<AxisCandidate> axes = wide.list;
    if (wide.isotropic && taken == 1 && complex_.points.size() <= kFewPoints) {
      for (AxisCandidate& axis : scattered_axes(complex_, options_.axis_origin, reach_)) {
        axes.push_back(std::move(axis));
      }
    }
    std::vector<PlcFit> near;
    int tried = 0;
    for (const AxisCandidate& axis : axes) {
      const std::vector<std::int32_t> folds = divisors_above_one(axis.greatest_fold);
      for (auto fold = folds.rbegin(); fold != folds.rend() && *fold > taken; ++fold) {
        SYMCELL_TRY(context_.check());
        if (*fold > kMostNearFold || ++tried > kMostTried) continue;
        PlcFit fit = wide_matcher().fit(*fold, axis.frame, adjust_);
        if (fit.accepted) near.push_back(std::move(fit));
      }
    }
    std::stable_sort(near.begin(), near.end(), [](const PlcFit& a, const PlcFit& b) {
      return std::pair(-a.fold, a.error) < std::pair(-b.fold, b.error);
    });
    std::vector<Warning> warnings;
    for (const PlcFit& fit : near) {
      if (warnings.size() == kMostNear) break;
      const double error = fit.error / complex_.diameter;
      const NearFold fold{fit.fold, error, tolerance_that_takes(error)};
      // Not if more tolerance is wanted for less.
      const bool of_use = std::all_of(warnings.begin(), warnings.end(), [&](const Warning& w) {
        const double share = w.near_fold->fold % fold.fold == 0 ? 0.5 : 1;
        return fold.tolerance_rel < share * w.near_fold->tolerance_rel;
      });
      if (!of_use) continue;
      MeshOptions wider = options_;
      wider.symmetry_tolerance_rel = fold.tolerance_rel;
      const auto found = SymmetrySearch(complex_, cells_, wider, context_).found_fold();
      if (!found) return error_of(found);
      if (*found != fold.fold) continue;
      warnings.push_back(near_symmetry_warning(fold, taken, tolerance_ / complex_.diameter));
    }
    return warnings;
  }

  const PlcMatcher& wide_matcher() {
    if (!wide_matcher_) {
      wide_matcher_.emplace(complex_, cells_, reach_, options_.ignore_markers);
    }
    return *wide_matcher_;
  }

  void fill_ladder(const AxisCandidates& axes,
                   const AxisCandidates& wide,
                   std::vector<PlcFit>& ladder) {
    if (!found_ && axes.list.empty()) return;
    const AxisCandidate& axis = best_.accepted ? best_axis_ : axes.list.front();
    constexpr std::size_t kRungs = 64;  // folds shown by inspection; each costs a fit
    std::vector<std::int32_t> folds = divisors_above_one(axis.greatest_fold);
    if (folds.size() > kRungs) folds.resize(kRungs);
    for (const AxisCandidate& other : wide.list) {
      if (!is_same_axis(other.frame, axis.frame)) continue;
      for (const std::int32_t fold : divisors_above_one(other.greatest_fold)) {
        if (fold <= kMostNearFold) folds.push_back(fold);
      }
    }
    std::sort(folds.begin(), folds.end());
    folds.erase(std::unique(folds.begin(), folds.end()), folds.end());
    for (const std::int32_t fold : folds) ladder.push_back(rung(fold, axis));
  }

  // As the fold would fit if it were given, else with the error over all turns where it nearly fits.
  PlcFit rung(std::int32_t fold, const AxisCandidate& axis) {
    PlcFit fit;
    if (best_.accepted) fit = matcher_.fit(fold, best_.frame, false);
    if (!fit.accepted) fit = matcher_.fit(fold, axis.frame, adjust_);
    if (fit.accepted || !fit.mismatch.empty()) return fit;
    PlcFit near = wide_matcher().fit(fold, axis.frame, adjust_);
    if (near.error > reach_) return fit;
    near.accepted = false;
    return near;
  }

  [[nodiscard]] Failure not_symmetric() const {
    const double limit = tolerance_ / complex_.diameter;
    Error error;
    error.code = ErrorCode::kNotSymmetric;
    error.message = "the model is not " + std::to_string(*options_.fold) +
                    "-fold symmetric about the axis through " + describe_point(best_.frame.origin) +
                    " along " + describe_point(best_.frame.direction()) +
                    " within the tolerance of " + describe_rounded(limit) + " of its diameter: ";
    if (best_.mismatch.empty() || best_.error > tolerance_) {
      error.message +=
          "error " + describe_rounded(best_.error / complex_.diameter) +
          " of the diameter, worst at vertex " + std::to_string(best_.worst_vertex) + " at " +
          describe_point(complex_.points[static_cast<std::size_t>(best_.worst_vertex)]);
      error.elements = {best_.worst_vertex};
      error.pointer = "/vertices/" + std::to_string(best_.worst_vertex);
    } else {
      error.message += best_.mismatch;
      error.elements = best_.elements;
    }
    error.message += "; correct the model, the fold or the axis, or raise the tolerance";
    return fail(std::move(error));
  }

  const PlcComplex& complex_;
  const PlcCells& cells_;
  const MeshOptions& options_;
  ExecutionContext& context_;
  double tolerance_;
  double reach_;  // up to which a fold is near
  bool adjust_;
  PlcMatcher matcher_;
  bool found_ = false;
  PlcFit best_;
  AxisCandidate best_axis_;
  int reported_ = 0;
  std::optional<PlcMatcher> wide_matcher_;
  bool ambiguous_ = false;  // another axis has the fold of the best one
  int equal_tried_ = 0;
};

}  // namespace

Result<PlcFit> find_plc_symmetry(const PlcComplex& complex,
                                 const PlcCells& cells,
                                 const MeshOptions& options,
                                 std::vector<PlcFit>* ladder,
                                 ExecutionContext& context) {
  SYMCELL_TRY(check_options(options));
  return SymmetrySearch(complex, cells, options, context).run(ladder);
}

}  // namespace symcell::solid
