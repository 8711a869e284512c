#include "core/solid/symmetry/detect_surface_symmetry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/model/describe.hpp"
#include "core/solid/surface/mass_properties.hpp"
#include "core/solid/symmetry/shape_symmetry.hpp"

namespace symcell::solid {
namespace {

// Folds looked for; a larger one can be given.
constexpr std::int32_t kMostDetected = 400;
// Where more folds fit at a first look, the shape is nearly one of revolution, and those count that
// fit much better than arbitrary angles.
constexpr std::size_t kManyFolds = 24;
// The first look is about an axis not yet refined.
constexpr double kRoughTolerances = 6;
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
// A fold stands out, or rules another one out, if its error is smaller by this factor.
constexpr double kDominance = 4;
// Of two folds the larger one leads unless the other fits better by this factor.
constexpr double kMuchBetter = 0.7;
// Below the noise of single precision, of the diameter, all errors are equal.
constexpr double kNoiseRel = 1e-6;
constexpr double kAcceptedAnyway = 1e-3;  // of the diameter
// Angles no regular polygon fits: the golden section and its like, of a full turn.
constexpr std::array<double, 3> kOddAngles = {0.381966011250105, 0.135335283236613,
                                              0.070735301630646};
// A refined axis so near to a coordinate axis, or an origin so near to 0, means these.
constexpr double kNiceRel = 2e-5;

bool finite(Point3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

std::string describe_rounded_point(Point3 p) {
  return "(" + describe_rounded(p.x) + ", " + describe_rounded(p.y) + ", " + describe_rounded(p.z) +
         ")";
}

struct AxisResult {
  SymmetryAxis axis;
  std::int32_t fold = 1;
  double error = 0;  // input units
  bool revolution = false;
  std::vector<FoldCandidate> folds;
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
        shape_(clean.surface, clean.diameter) {}

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
    AxisResult result;
    result.axis.origin = options_.axis_origin.value_or(mass_.centroid);
    result.axis.direction = options_.axis_direction.value_or(Point3{0, 0, 1});
    return finish(result);
  }

  [[nodiscard]] DetectedSymmetry finish(const AxisResult& found) const {
    DetectedSymmetry result;
    Symmetry& s = result.symmetry;
    s.fold = found.fold;
    s.error_rel = found.error / diameter_;
    s.diameter = diameter_;
    s.fold_detected = !options_.fold;
    s.axis_detected = !options_.axis_direction;
    s.frame = AxisFrame::of_axis(found.axis.origin, found.axis.direction);
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

  [[nodiscard]] SymmetryAxis refined(const SymmetryAxis& axis, std::int32_t fold) const {
    const double angle = 2 * std::numbers::pi / fold;
    SymmetryAxis better =
        shape_.refined(axis, angle, !options_.axis_origin, !options_.axis_direction);
    return nicer(better, angle);
  }

  // Coordinate axes and planes through 0 where they fit as well: flat ends become exactly flat.
  [[nodiscard]] SymmetryAxis nicer(const SymmetryAxis& axis, double angle) const {
    SymmetryAxis nice = axis;
    const auto snap = [](double& x, double value, double reach) {
      if (std::abs(x - value) <= reach) x = value;
    };
    for (double* x : {&nice.direction.x, &nice.direction.y, &nice.direction.z}) {
      for (const double value : {-1.0, 0.0, 1.0}) snap(*x, value, kNiceRel);
    }
    const double norm = length(nice.direction);
    nice.direction = (1 / norm) * nice.direction;
    if (!options_.axis_origin) {
      for (double* x : {&nice.origin.x, &nice.origin.y, &nice.origin.z}) {
        snap(*x, 0, kNiceRel * diameter_);
      }
    }
    if (options_.axis_direction) nice.direction = axis.direction;
    constexpr std::size_t kSamples = 1000;  // points: two means are compared to 5 %
    const double cap = tolerance_;
    const double before = shape_.mean_error(axis, angle, cap, kSamples);
    const double after = shape_.mean_error(nice, angle, cap, kSamples);
    // Equal but for the noise of single precision.
    return after <= 1.05 * before + 1e-6 * diameter_ ? nice : axis;
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
    AxisResult best;
    ShapeError best_error;
    best_error.distance = kInfinity;
    for (const SymmetryAxis& candidate : by_fit(axes, n)) {
      // The others are far off, and refining them takes its time.
      if (best.fold == n && best.error <= tolerance_ && !fits_nearly(candidate, n)) break;
      const SymmetryAxis axis = refined(candidate, n);
      // A better axis than those before, or it does not matter how bad.
      auto error = shape_.error(axis, n, best_error.distance, context_);
      if (!error) return error_of(error);
      if (error->distance >= best_error.distance) continue;
      best_error = *error;
      best.axis = axis;
      best.fold = n;
      best.error = error->distance;
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
    best.folds.push_back({n, best.error / diameter_, true});
    return finish(best);
  }

  Result<DetectedSymmetry> detect_fold(const std::vector<SymmetryAxis>& axes) {
    AxisResult best;
    best.axis = axes.front();
    bool revolution = false;
    for (const SymmetryAxis& candidate : axes) {
      auto result = ladder(candidate);
      if (!result) return error_of(result);
      if (result->revolution) {
        revolution = true;
        best = *result;
        break;
      }
      const bool better =
          result->fold > best.fold ||
          (result->fold == best.fold && result->fold > 1 && result->error < best.error);
      if (better) {
        best = *result;
      } else if (best.fold == 1 && best.folds.size() < result->folds.size()) {
        best.folds = result->folds;
      }
    }
    if (revolution) {
      return fail(ErrorCode::kAmbiguousSymmetry,
                  "the surface is one of revolution about the axis through " +
                      describe_rounded_point(best.axis.origin) + " along " +
                      describe_rounded_point(best.axis.direction) +
                      ": every fold fits within the tolerance; give the fold");
    }
    return finish(best);
  }

  Result<AxisResult> ladder(const SymmetryAxis& candidate) {
    AxisResult result;
    result.axis = candidate;
    std::vector<std::int32_t> folds = quick_folds(candidate, kRoughTolerances * tolerance_);
    if (folds.empty()) return result;
    // The fold that fits best so far determines the axis best; larger ones first among equals.
    std::int32_t leader = folds.front();
    double leading = kInfinity;
    for (const std::int32_t n : folds) {
      constexpr std::size_t kSamples = 300;  // points, for each of up to 400 folds
      const double error =
          shape_.mean_error(candidate, 2 * std::numbers::pi / n, kRoughTolerances * tolerance_,
                            kSamples, kMuchBetter * leading);
      if (error < kMuchBetter * leading) {
        leading = error;
        leader = n;
      }
    }
    result.axis = refined(candidate, leader);
    folds = quick_folds(result.axis, tolerance_);
    const bool revolution = !folds.empty() && fits_odd_angles(result.axis);
    if (revolution || folds.size() > kManyFolds) {
      auto better = outstanding(result.axis, folds);
      if (better.empty() && revolution) {
        result.revolution = true;
        return result;
      }
      if (better.empty()) {
        folds.resize(kManyFolds);
      } else {
        folds = std::move(better);
      }
    }
    std::vector<FoldCandidate>& rungs = result.folds;
    // Turns that folds have in common are measured once.
    std::map<std::pair<std::int32_t, std::int32_t>, double> turns;
    const double enough = 4 * tolerance_;
    for (const std::int32_t n : folds) {
      double worst = 0;
      // Where a few points show that a turn is out of the question it is the only one to measure.
      const std::int32_t misfit = misfitting_turn(result.axis, n);
      for (std::int32_t k = misfit > 0 ? misfit : 1; k < n && worst <= enough; ++k) {
        const std::int32_t g = std::gcd(k, n);
        const auto [turn, fresh] = turns.try_emplace({k / g, n / g}, 0.0);
        if (fresh) {
          auto error = shape_.turn_error(result.axis, k, n, enough, context_);
          if (!error) return error_of(error);
          turn->second = error->distance;
        }
        worst = std::max(worst, turn->second);
        if (misfit > 0) break;
      }
      rungs.push_back({n, worst / diameter_, false});
    }
    judge(result);
    return result;
  }

  [[nodiscard]] std::vector<std::int32_t> quick_folds(const SymmetryAxis& axis,
                                                      double reach) const {
    std::vector<std::int32_t> folds;
    for (std::int32_t n = 2; n <= kMostDetected; ++n) {
      if (shape_.fits(axis, 2 * std::numbers::pi / n, reach)) folds.push_back(n);
    }
    return folds;
  }

  // A turn of a fold that does not fit, 0: all do. Turns far from each other first: small ones move
  // nothing far.
  [[nodiscard]] std::int32_t misfitting_turn(const SymmetryAxis& axis, std::int32_t n) const {
    std::int32_t step = std::max(1, static_cast<std::int32_t>(kOddAngles.front() * n));
    while (std::gcd(step, n) != 1) ++step;
    std::int32_t k = 0;
    for (std::int32_t i = 1; i < n; ++i) {
      k = (k + step) % n;
      if (!shape_.fits(axis, 2 * std::numbers::pi * k / n, tolerance_)) return k;
    }
    return 0;
  }

  [[nodiscard]] bool fits_odd_angles(const SymmetryAxis& axis) const {
    return std::all_of(kOddAngles.begin(), kOddAngles.end(), [&](double share) {
      return shape_.fits(axis, 2 * std::numbers::pi * share, tolerance_);
    });
  }

  // Of a shape that all angles fit: the folds that fit much better than an odd angle.
  [[nodiscard]] std::vector<std::int32_t> outstanding(
      const SymmetryAxis& axis, const std::vector<std::int32_t>& folds) const {
    constexpr std::size_t kSamples = 1000;  // points: means are compared to a factor of four
    const auto mean = [&](double share) {
      return shape_.mean_error(axis, 2 * std::numbers::pi * share, tolerance_, kSamples);
    };
    double odd = 0;
    for (const double share : kOddAngles) odd = std::max(odd, mean(share));
    std::vector<std::int32_t> better;
    // By the turns of a fold that come near those angles: small ones move nothing far.
    const auto stands_out = [&](std::int32_t n) {
      return std::all_of(kOddAngles.begin(), kOddAngles.end(), [&](double share) {
        const double turn = std::max(1.0, std::round(share * n)) / n;
        return std::max(mean(turn), kNoiseRel * diameter_) <= odd / kDominance;
      });
    };
    for (const std::int32_t n : folds) {
      if (stands_out(n)) better.push_back(n);
    }
    return better;
  }

  void judge(AxisResult& result) const {
    std::vector<FoldCandidate>& rungs = result.folds;
    for (FoldCandidate& c : rungs) {
      c.accepted = c.error_rel * diameter_ <= tolerance_;
      double divisors = kInfinity;
      for (const FoldCandidate& o : rungs) {
        if (o.fold == c.fold) continue;
        const bool divides = c.fold % o.fold == 0, multiple = o.fold % c.fold == 0;
        if (!divides && !multiple && std::max(o.error_rel, kNoiseRel) < c.error_rel / kDominance) {
          c.accepted = false;
        }
        if (divides) divisors = std::min(divisors, std::max(o.error_rel, kNoiseRel));
      }
      if (divisors < kInfinity && c.error_rel > std::max(kAcceptedAnyway, kDominance * divisors)) {
        c.accepted = false;
      }
    }
    for (const FoldCandidate& c : rungs) {
      if (!c.accepted) continue;
      result.fold = c.fold;
      result.error = c.error_rel * diameter_;
    }
  }

  const CleanSurface& clean_;
  const MeshOptions& options_;
  ExecutionContext& context_;
  double diameter_;
  double tolerance_;
  ShapeSymmetry shape_;
  MassProperties mass_;
};

}  // namespace

Result<DetectedSymmetry> detect_surface_symmetry(const CleanSurface& clean,
                                                 const MeshOptions& options,
                                                 ExecutionContext& context) {
  return Detector(clean, options, context).run();
}

}  // namespace symcell::solid
