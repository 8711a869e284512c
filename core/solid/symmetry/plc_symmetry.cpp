#include "core/solid/symmetry/plc_symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/geometry/limits.hpp"
#include "core/geometry/resolution.hpp"
#include "core/model/describe.hpp"
#include "core/solid/symmetry/plc_axes.hpp"

namespace symcell::solid {
namespace {

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
  SymmetrySearch(const PlcComplex& complex,
                 const PlcCells& cells,
                 const MeshOptions& options,
                 ExecutionContext& context)
      : complex_(complex),
        options_(options),
        context_(context),
        tolerance_(std::max(
            options.symmetry_tolerance_rel.value_or(kExactSymmetryToleranceRel) * complex.diameter,
            resolution_of(complex.diameter, complex.magnitude))),
        adjust_(!(options.axis_origin && options.axis_direction)),
        matcher_(complex, cells, tolerance_, options.ignore_markers) {}

  Result<PlcFit> run(std::vector<PlcFit>* ladder) {
    if (options_.fold == 1) return without_symmetry();
    AxisCandidates axes =
        principal_axes(complex_, options_.axis_origin, options_.axis_direction, tolerance_);
    SYMCELL_TRY(try_all(axes.list));
    if (axes.isotropic || (axes.open && !best_.accepted)) {
      SYMCELL_TRY(try_all(scattered_axes(complex_, options_.axis_origin, tolerance_)));
    }
    if (!best_.accepted && options_.fold) return not_symmetric();
    if (ladder != nullptr) fill_ladder(axes, *ladder);
    if (!best_.accepted) return without_symmetry();
    return best_;
  }

 private:
  Result<PlcFit> without_symmetry() const {
    return matcher_.fit(1, plain_frame(complex_, options_), false);
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
        consider(matcher_.fit(fold, axis.frame, adjust_), axis);
        continue;
      }
      const std::vector<std::int32_t> folds = divisors_above_one(axis.greatest_fold);
      for (auto fold = folds.rbegin(); fold != folds.rend(); ++fold) {
        if (best_.accepted && *fold <= best_.fold) break;
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
    found_ = true;
    best_ = fit;
    best_axis_ = axis;
  }

  void fill_ladder(const AxisCandidates& axes, std::vector<PlcFit>& ladder) const {
    if (!found_ && axes.list.empty()) return;
    const AxisCandidate& axis = best_.accepted ? best_axis_ : axes.list.front();
    const AxisFrame& frame = best_.accepted ? best_.frame : axis.frame;
    constexpr std::size_t kRungs = 64;  // folds shown by inspection; each costs a fit
    std::vector<std::int32_t> folds = divisors_above_one(axis.greatest_fold);
    if (folds.size() > kRungs) folds.resize(kRungs);
    for (const std::int32_t fold : folds) {
      ladder.push_back(matcher_.fit(fold, frame, adjust_ && !best_.accepted));
    }
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
  const MeshOptions& options_;
  ExecutionContext& context_;
  double tolerance_;
  bool adjust_;
  PlcMatcher matcher_;
  bool found_ = false;
  PlcFit best_;
  AxisCandidate best_axis_;
  int reported_ = 0;
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
