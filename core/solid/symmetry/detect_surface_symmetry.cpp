#include "core/solid/symmetry/detect_surface_symmetry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/model/describe.hpp"
#include "core/solid/surface/mass_properties.hpp"
#include "core/solid/symmetry/axis_ladder.hpp"
#include "core/solid/symmetry/shape_symmetry.hpp"

namespace symcell::solid {
namespace {

// Principal moments that differ by less determine no axis.
constexpr double kSimilarMoments = 0.01;
// Directions spread over half a sphere where the moments are equal: fewer lie too far apart for the
// refinement to find the axis, more take their time.
constexpr std::size_t kScannedDirections = 1500;
// Half the spacing of those directions (radians) times half a diameter, as a share of it.
constexpr double kScanReach = 0.025;
// Points that judge a direction, and how many of the best directions are refined: a scan is rough,
// and there may be that many axes of a cube or the like (13) and as many near misses.
constexpr std::size_t kScanSamples = 60;
constexpr std::size_t kRefinedOfScan = 24;
constexpr std::int32_t kMostScannedFold = 6;  // equal moments come with cubic symmetry
// Mean distances, of the diameter, that no refinement of an axis mends.
constexpr double kFarOff = 0.04;
// Axes nearer than this (radians) are one.
constexpr double kSameAxis = 1e-2;
// Of a surface that is coarsely one of revolution, every angle fits within so many tolerances.
constexpr double kCoarseTolerances = 2;
// Folds proposed for a surface of revolution, of which the first that fits is named.
constexpr std::array<std::int32_t, 7> kProposed = {8, 12, 6, 4, 3, 5, 2};
// Folds that fit nearly: so many are reported, after so many attempts.
constexpr std::size_t kMostNear = 3;
constexpr int kMostNearTried = 5;
// A smaller fold is worth a word beside a multiple of it if this much less tolerance takes it.
constexpr double kMuchSmaller = 0.5;

bool finite(Point3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

std::string describe_rounded_point(Point3 p) {
  return "(" + describe_rounded(p.x) + ", " + describe_rounded(p.y) + ", " + describe_rounded(p.z) +
         ")";
}

// A fold beyond the tolerance, about one of the candidate axes.
struct NearRung {
  SymmetryAxis candidate;
  std::int32_t fold = 1;
  double error = 0;  // input units
};

class Detector {
 public:
  Detector(const CleanSurface& clean, const MeshOptions& options, ExecutionContext& context)
      : clean_(clean),
        options_(options),
        context_(context),
        diameter_(clean.diameter),
        tolerance_(options.symmetry_tolerance_rel.value_or(kSurfaceSymmetryToleranceRel) *
                   clean.diameter),
        shape_(clean.surface, clean.diameter),
        ladders_(shape_,
                 clean.diameter,
                 {options.axis_origin.has_value(), options.axis_direction.has_value()},
                 context) {}

  Result<DetectedSymmetry> run() {
    SYMCELL_TRY(check_options());
    mass_ = mass_properties(clean_.surface);
    if (options_.fold == 1) return whole_model();
    auto axes = candidate_axes();
    if (!axes) return error_of(axes);
    return options_.fold ? check_fold(*axes) : detect_fold(*axes);
  }

 private:
  [[nodiscard]] Result<void> check_options() const {
    if (options_.fold && (*options_.fold < 1 || *options_.fold > kMaxFold)) {
      return fail(ErrorCode::kBadFold, "fold " + std::to_string(*options_.fold) +
                                           " is not in 1 to " + std::to_string(kMaxFold));
    }
    if (options_.axis_direction &&
        (!finite(*options_.axis_direction) || !(length(*options_.axis_direction) > 0))) {
      return fail(ErrorCode::kBadAxis, "the axis direction " +
                                           describe_point(*options_.axis_direction) +
                                           " is no direction; give a vector that is not zero");
    }
    if (options_.axis_origin && !finite(*options_.axis_origin)) {
      return fail(ErrorCode::kBadAxis,
                  "the axis origin " + describe_point(*options_.axis_origin) + " is not finite");
    }
    return {};
  }

  [[nodiscard]] DetectedSymmetry whole_model() const {
    AxisLadder result;
    result.axis.origin = options_.axis_origin.value_or(mass_.centroid);
    result.axis.direction = options_.axis_direction.value_or(Point3{0, 0, 1});
    return finish(result);
  }

  [[nodiscard]] DetectedSymmetry finish(const AxisLadder& found) const {
    DetectedSymmetry result;
    Symmetry& s = result.symmetry;
    s.fold = found.fold;
    s.error_rel = found.error / diameter_;
    s.diameter = diameter_;
    s.fold_detected = !options_.fold;
    s.axis_detected = !options_.axis_direction;
    s.frame = AxisFrame::of_axis(found.axis.origin, found.axis.direction);
    if (s.fold_detected && s.fold == 1) {
      s.warnings.push_back(no_symmetry_warning(tolerance_ / diameter_));
    }
    if (ambiguous_) {
      s.warnings.push_back(axis_ambiguous_warning(s.fold, found.axis.origin, found.axis.direction));
    }
    result.folds = found.folds;
    return result;
  }

  // Axes through the centroid as a rule: the centroid of a symmetric body is on its axis.
  Result<std::vector<SymmetryAxis>> candidate_axes() {
    const Point3 origin = options_.axis_origin.value_or(mass_.centroid);
    std::vector<SymmetryAxis> axes;
    if (options_.axis_direction) {
      const Point3 d = *options_.axis_direction;
      return std::vector<SymmetryAxis>{{origin, (1 / length(d)) * d}};
    }
    for (const Point3& d : mass_.directions) axes.push_back({origin, d});
    const auto& m = mass_.moments;
    if (m[2] - m[0] < kSimilarMoments * m[2]) {
      SYMCELL_TRY(scan(origin, axes));
    }
    return axes;
  }

  // Directions spread over the half sphere; the best few, refined.
  Result<void> scan(Point3 origin, std::vector<SymmetryAxis>& axes) {
    struct Scanned {
      double error;
      std::int32_t fold;
      SymmetryAxis axis;
    };
    std::vector<Scanned> scanned;
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    const std::int32_t first = options_.fold.value_or(2);
    const std::int32_t last = options_.fold.value_or(kMostScannedFold);
    for (std::size_t i = 0; i < kScannedDirections; ++i) {
      SYMCELL_TRY(context_.check());
      const double z = (static_cast<double>(i) + 0.5) / kScannedDirections;
      const double r = std::sqrt(1 - z * z), phi = golden * static_cast<double>(i);
      const SymmetryAxis axis{origin, {r * std::cos(phi), r * std::sin(phi), z}};
      for (std::int32_t n = first; n <= last; ++n) {
        const double angle = 2 * std::numbers::pi / n;
        const double cap = 4 * kScanReach * diameter_;
        scanned.push_back({shape_.mean_error(axis, angle, cap, kScanSamples), n, axis});
      }
    }
    std::stable_sort(scanned.begin(), scanned.end(),
                     [](const Scanned& a, const Scanned& b) { return a.error < b.error; });
    std::size_t refined = 0;
    for (const Scanned& s : scanned) {
      if (refined == kRefinedOfScan) break;
      if (known(axes, s.axis.direction, 0.06)) continue;
      ++refined;
      const double angle = 2 * std::numbers::pi / s.fold;
      const SymmetryAxis axis = shape_.refined(s.axis, angle, !options_.axis_origin, true);
      if (!known(axes, axis.direction, kSameAxis)) axes.push_back(axis);
    }
    return {};
  }

  [[nodiscard]] static bool known(const std::vector<SymmetryAxis>& axes, Point3 d, double angle) {
    return std::any_of(axes.begin(), axes.end(), [&](const SymmetryAxis& a) {
      return length(cross(a.direction, d)) < angle;
    });
  }

  // The axes about which a turn misses the surface least come first.
  [[nodiscard]] std::vector<SymmetryAxis> by_fit(const std::vector<SymmetryAxis>& axes,
                                                 std::int32_t fold) const {
    std::vector<std::pair<double, SymmetryAxis>> judged;
    for (const SymmetryAxis& axis : axes) judged.emplace_back(rough_error(axis, fold), axis);
    std::stable_sort(judged.begin(), judged.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<SymmetryAxis> sorted;
    for (const auto& [error, axis] : judged) sorted.push_back(axis);
    return sorted;
  }
  [[nodiscard]] double rough_error(const SymmetryAxis& axis, std::int32_t fold) const {
    constexpr std::size_t kSamples = 200;  // points: a rough look that sorts the axes
    return shape_.mean_error(axis, 2 * std::numbers::pi / fold, kFarOff * diameter_, kSamples);
  }
  [[nodiscard]] bool fits_nearly(const SymmetryAxis& axis, std::int32_t fold) const {
    return rough_error(axis, fold) <= std::max(kFarOff / 2 * diameter_, 10 * tolerance_);
  }

  Result<DetectedSymmetry> check_fold(const std::vector<SymmetryAxis>& axes) {
    const std::int32_t n = *options_.fold;
    AxisLadder best;
    ShapeError best_error;
    best_error.distance = kInfinity;
    std::vector<SymmetryAxis> accepted;
    for (const SymmetryAxis& candidate : by_fit(axes, n)) {
      // The others are far off, and refining them takes its time.
      if (best.fold == n && best.error <= tolerance_ && !fits_nearly(candidate, n)) break;
      const SymmetryAxis axis = ladders_.refined(candidate, n, tolerance_);
      // A better axis than those before, or another one that will do, or it does not matter how
      // bad.
      const double enough =
          ambiguous_ ? best_error.distance : std::max(best_error.distance, tolerance_);
      auto error = shape_.error(axis, n, enough, context_);
      if (!error) return error_of(error);
      if (error->distance <= tolerance_ && !known(accepted, axis.direction, kSameAxis)) {
        ambiguous_ = !accepted.empty() && !options_.axis_direction;
        accepted.push_back(axis);
      }
      if (error->distance >= best_error.distance) continue;
      best_error = *error;
      best.axis = axis;
      best.fold = n;
      best.error = error->distance;
    }
    if (best.error > tolerance_ && best.error <= kCoarseTolerances * tolerance_) {
      SYMCELL_TRY(check_as_detected(axes, best));
    }
    if (best.error > tolerance_) {
      return fail(ErrorCode::kNotSymmetric,
                  "the surface is not " + std::to_string(n) + "-fold symmetric about the axis " +
                      "through " + describe_rounded_point(best.axis.origin) + " along " +
                      describe_rounded_point(best.axis.direction) + ": the point " +
                      describe_rounded_point(best_error.worst) + " turned by " +
                      std::to_string(best_error.steps) + "/" + std::to_string(n) + " lies " +
                      describe_rounded(best.error) + " (" +
                      describe_rounded(best.error / diameter_) +
                      " of the diameter) from the surface, the tolerance is " +
                      describe_rounded(tolerance_ / diameter_) +
                      "; give another fold or axis, or a larger symmetry_tolerance");
    }
    best.folds.push_back({n, best.error / diameter_, true, best_error.worst});
    return finish(best);
  }

  // What detection would find is accepted when it is given: other folds may determine the axis
  // better.
  Result<void> check_as_detected(const std::vector<SymmetryAxis>& axes, AxisLadder& best) const {
    const std::int32_t n = *options_.fold;
    for (const SymmetryAxis& candidate : axes) {
      if (!fits_nearly(candidate, n)) continue;
      const auto ladder = ladders_.climb(candidate, tolerance_);
      if (!ladder) return error_of(ladder);
      if (ladder->fold % n != 0) continue;
      const auto error = shape_.error(ladder->axis, n, best.error, context_);
      if (!error) return error_of(error);
      if (error->distance >= best.error) continue;
      best.axis = ladder->axis;
      best.error = error->distance;
    }
    return {};
  }

  Result<DetectedSymmetry> detect_fold(const std::vector<SymmetryAxis>& axes) {
    AxisLadder best;
    best.axis = axes.front();
    std::vector<NearRung> near;
    std::vector<SymmetryAxis> equal;  // of the fold of `best`
    std::vector<SymmetryAxis> nearly_round;
    for (const SymmetryAxis& candidate : axes) {
      auto ladder = ladders_.climb(candidate, tolerance_);
      if (!ladder) return error_of(ladder);
      if (ladder->revolution) return revolution(ladder->axis, 0);
      SYMCELL_TRY(ladders_.widen(candidate, tolerance_, *ladder));
      if (ladder->many) nearly_round.push_back(candidate);
      for (const FoldCandidate& c : ladder->folds) {
        if (!c.accepted) near.push_back({candidate, c.fold, c.error_rel * diameter_});
      }
      if (ladder->fold > best.fold) equal.clear();
      if (ladder->fold >= best.fold && !known(equal, ladder->axis.direction, kSameAxis)) {
        equal.push_back(ladder->axis);
      }
      const bool better =
          ladder->fold > best.fold ||
          (ladder->fold == best.fold && ladder->fold > 1 && ladder->error < best.error);
      if (better) {
        best = *ladder;
      } else if (best.fold == 1 && best.folds.size() < ladder->folds.size()) {
        best.folds = ladder->folds;
      }
    }
    if (best.fold == 1) {
      for (const SymmetryAxis& candidate : nearly_round) {
        const auto round =
            ladders_.revolution(candidate, tolerance_, kCoarseTolerances * tolerance_);
        if (!round) return error_of(round);
        if (round->error < kInfinity) return revolution(round->axis, round->error);
      }
    }
    ambiguous_ = best.fold > 1 && equal.size() > 1 && !options_.axis_direction;
    DetectedSymmetry result = finish(best);
    auto warnings = near_warnings(std::move(near), best.fold);
    if (!warnings) return error_of(warnings);
    auto& all = result.symmetry.warnings;
    all.insert(all.begin(), warnings->begin(), warnings->end());
    return result;
  }

  // Of the folds that a larger tolerance would take, the largest; each with the smallest tolerance.
  Result<std::vector<Warning>> near_warnings(std::vector<NearRung> near, std::int32_t taken) const {
    std::stable_sort(near.begin(), near.end(), [](const NearRung& a, const NearRung& b) {
      return std::pair(-a.fold, a.error) < std::pair(-b.fold, b.error);
    });
    std::vector<Warning> warnings;
    std::vector<NearFold> reported;
    int tried = 0;
    for (const NearRung& rung : near) {
      if (reported.size() == kMostNear || tried == kMostNearTried) break;
      const NearFold fold{rung.fold, rung.error / diameter_,
                          tolerance_that_takes(rung.error / diameter_)};
      // Not if more tolerance is wanted for less.
      const bool of_use =
          fold.fold > taken && std::ranges::all_of(reported, [&](const NearFold& larger) {
            const double share = larger.fold % fold.fold == 0 ? kMuchSmaller : 1;
            return fold.tolerance_rel < share * larger.tolerance_rel;
          });
      if (!of_use) continue;
      ++tried;
      const auto holds =
          ladders_.takes(rung.candidate, fold.fold, rung.error, fold.tolerance_rel * diameter_);
      if (!holds) return error_of(holds);
      if (!*holds) continue;
      reported.push_back(fold);
      warnings.push_back(near_symmetry_warning(fold, taken, tolerance_ / diameter_));
    }
    return warnings;
  }

  // `odd`: by how much odd angles miss, if that was measured; input units.
  Failure revolution(const SymmetryAxis& axis, double odd) const {
    std::int32_t proposed = 0;
    double least = kInfinity, most = odd;
    for (const std::int32_t n : kProposed) {
      const SymmetryAxis own = ladders_.refined(axis, n, tolerance_);
      const auto error = shape_.error(own, n, kInfinity, context_);
      if (!error) return error_of(error);
      most = std::max(most, error->distance);
      if (error->distance >= least) continue;
      least = error->distance;
      proposed = n;
      if (least <= tolerance_) break;
    }
    const bool nearly = most > tolerance_;
    const std::string tolerance = describe_number(tolerance_ / diameter_);
    std::string message = "the surface is " + std::string(nearly ? "nearly " : "") +
                          "one of revolution about the axis through " +
                          describe_rounded_point(axis.origin) + " along " +
                          describe_rounded_point(axis.direction) + ": ";
    if (nearly) {
      message += "angles of all kinds fit to within " +
                 describe_number(tolerance_that_takes(most / diameter_)) +
                 " of its diameter, the tolerance is " + tolerance;
    } else {
      message += "every fold fits within the tolerance of " + tolerance + " of its diameter";
    }
    message += "; give the fold that is meant, for example fold=" + std::to_string(proposed);
    if (least > tolerance_) {
      message +=
          " with symmetry_tolerance=" + describe_number(tolerance_that_takes(least / diameter_));
    }
    return fail(ErrorCode::kAmbiguousSymmetry, message + ", or fold=1 to mesh the whole", {},
                "/options/fold");
  }

  const CleanSurface& clean_;
  const MeshOptions& options_;
  ExecutionContext& context_;
  double diameter_;
  double tolerance_;
  ShapeSymmetry shape_;
  AxisLadders ladders_;
  MassProperties mass_;
  bool ambiguous_ = false;  // another axis has the same fold
};

}  // namespace

Result<DetectedSymmetry> detect_surface_symmetry(const CleanSurface& clean,
                                                 const MeshOptions& options,
                                                 ExecutionContext& context) {
  return Detector(clean, options, context).run();
}

}  // namespace symcell::solid
