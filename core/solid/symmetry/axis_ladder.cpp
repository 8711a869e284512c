#include "core/solid/symmetry/axis_ladder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace symcell::solid {
namespace {

// Folds looked for; a larger one can be given.
constexpr std::int32_t kMostDetected = 400;
// Where more folds fit at a first look, the shape is nearly one of revolution, and those count that
// fit much better than arbitrary angles.
constexpr std::size_t kManyFolds = 24;
// The first look is about an axis not yet refined.
constexpr double kRoughTolerances = 6;
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
// The largest tolerance that can be given, of the diameter: nothing beyond it is near.
constexpr double kMostToleranceRel = 0.1;
// Folds beyond the tolerance whose axis is refined for them; each costs a measurement.
constexpr int kMostRefined = 8;
constexpr double kWorthRefining = 2;  // tolerances: a better axis hardly halves an error

double angle_of(std::int32_t fold) {
  return 2 * std::numbers::pi / fold;
}

// Sectors that turn by about the first odd angle.
double odd_angle_of(std::int32_t fold) {
  return std::max(1.0, std::round(kOddAngles.front() * fold)) * angle_of(fold);
}

double reach_of(double tolerance, double diameter) {
  return std::min(kNearTolerances * tolerance, kMostToleranceRel * diameter);
}

}  // namespace

SymmetryAxis AxisLadders::refined(const SymmetryAxis& axis,
                                  std::int32_t fold,
                                  double tolerance) const {
  return refined_by(angle_of(fold), axis, tolerance);
}

SymmetryAxis AxisLadders::refined_by(double angle,
                                     const SymmetryAxis& axis,
                                     double tolerance) const {
  return nicer(shape_.refined(axis, angle, !fixed_.origin, !fixed_.direction), angle, tolerance);
}

// Coordinate axes and planes through 0 where they fit as well: flat ends become exactly flat.
SymmetryAxis AxisLadders::nicer(const SymmetryAxis& axis, double angle, double tolerance) const {
  SymmetryAxis nice = axis;
  const auto snap = [](double& x, double value, double reach) {
    if (std::abs(x - value) <= reach) x = value;
  };
  for (double* x : {&nice.direction.x, &nice.direction.y, &nice.direction.z}) {
    for (const double value : {-1.0, 0.0, 1.0}) snap(*x, value, kNiceRel);
  }
  const double norm = length(nice.direction);
  nice.direction = (1 / norm) * nice.direction;
  if (!fixed_.origin) {
    for (double* x : {&nice.origin.x, &nice.origin.y, &nice.origin.z}) {
      snap(*x, 0, kNiceRel * diameter_);
    }
  }
  if (fixed_.direction) nice.direction = axis.direction;
  constexpr std::size_t kSamples = 1000;  // points: two means are compared to 5 %
  const double before = shape_.mean_error(axis, angle, tolerance, kSamples);
  const double after = shape_.mean_error(nice, angle, tolerance, kSamples);
  // Equal but for the noise of single precision.
  return after <= 1.05 * before + 1e-6 * diameter_ ? nice : axis;
}

// The fold that fits best so far determines the axis best; larger ones first among equals.
std::int32_t AxisLadders::leader(Turn turn,
                                 const SymmetryAxis& candidate,
                                 const std::vector<std::int32_t>& folds,
                                 double cap) const {
  std::int32_t leader = folds.front();
  double leading = kInfinity;
  for (const std::int32_t n : folds) {
    constexpr std::size_t kSamples = 300;  // points, for each of up to 400 folds
    const double angle = turn == Turn::kOne ? angle_of(n) : odd_angle_of(n);
    const double error = shape_.mean_error(candidate, angle, cap, kSamples, kMuchBetter * leading);
    if (error < kMuchBetter * leading) {
      leading = error;
      leader = n;
    }
  }
  return leader;
}

// Small turns move nothing far: about a shape that is nearly one of revolution they all fit, and
// determine no axis. There large ones get a second try.
Result<AxisLadder> AxisLadders::climb(const SymmetryAxis& candidate, double tolerance) const {
  auto ladder = climb_by(Turn::kOne, candidate, tolerance);
  if (!ladder || !ladder->many || ladder->fold > 1 || ladder->revolution) return ladder;
  auto again = climb_by(Turn::kOdd, candidate, tolerance);
  return !again || again->fold > 1 || again->revolution ? again : ladder;
}

Result<AxisLadder> AxisLadders::climb_by(Turn turn,
                                         const SymmetryAxis& candidate,
                                         double tolerance) const {
  AxisLadder result;
  result.axis = candidate;
  double rough = kRoughTolerances * tolerance;
  std::vector<std::int32_t> folds = quick_folds(candidate, rough, kMostDetected);
  result.many = folds.size() > kManyFolds;
  if (folds.empty()) {
    // What is near may be so far off that the axis is as well.
    rough += reach_of(tolerance, diameter_);
    folds = quick_folds(candidate, rough, kMostNearFold);
    std::erase_if(folds, [&](std::int32_t n) { return misfitting_turn(candidate, n, rough) > 0; });
  }
  if (folds.empty()) return result;
  const std::int32_t best = leader(turn, candidate, folds, rough);
  result.axis =
      refined_by(turn == Turn::kOne ? angle_of(best) : odd_angle_of(best), candidate, tolerance);
  folds = quick_folds(result.axis, tolerance, kMostDetected);
  const bool revolution = !folds.empty() && fits_odd_angles(result.axis, tolerance);
  if (revolution || folds.size() > kManyFolds) {
    auto better = outstanding(result.axis, folds, tolerance);
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
  const double enough = 4 * tolerance;
  for (const std::int32_t n : folds) {
    // Where a few points show that a turn is out of the question it is the only one to measure.
    const std::int32_t misfit = misfitting_turn(result.axis, n, tolerance);
    const auto worst = misfit > 0 ? measure(result, n, misfit, misfit, enough)
                                  : measure(result, n, 1, n - 1, enough);
    if (!worst) return error_of(worst);
    result.folds.push_back({n, worst->distance / diameter_, false, worst->worst});
  }
  judge(result, tolerance);
  return result;
}

// The worst of the turns from `first` to `last`.  Turns that folds have in common are measured once,
// unless the first time ended at a smaller bound.
Result<ShapeError> AxisLadders::measure(AxisLadder& ladder,
                                        std::int32_t n,
                                        std::int32_t first,
                                        std::int32_t last,
                                        double enough) const {
  ShapeError worst;
  for (std::int32_t k = first; k <= last && worst.distance <= enough; ++k) {
    const std::int32_t g = std::gcd(k, n);
    const auto [turn, fresh] = ladder.turns.try_emplace({k / g, n / g});
    if (fresh) {
      auto error = shape_.turn_error(ladder.axis, k, n, enough, context_);
      if (!error) return error_of(error);
      turn->second = *error;
    }
    if (turn->second.distance > worst.distance) worst = turn->second;
  }
  return worst;
}

std::vector<std::int32_t> AxisLadders::quick_folds(const SymmetryAxis& axis,
                                                   double reach,
                                                   std::int32_t last) const {
  std::vector<std::int32_t> folds;
  for (std::int32_t n = 2; n <= last; ++n) {
    if (shape_.fits(axis, angle_of(n), reach)) folds.push_back(n);
  }
  return folds;
}

// A turn of a fold that does not fit, 0: all do. Turns far from each other first: small ones move
// nothing far.
std::int32_t AxisLadders::misfitting_turn(const SymmetryAxis& axis,
                                          std::int32_t n,
                                          double reach) const {
  std::int32_t step = std::max(1, static_cast<std::int32_t>(kOddAngles.front() * n));
  while (std::gcd(step, n) != 1) ++step;
  std::int32_t k = 0;
  for (std::int32_t i = 1; i < n; ++i) {
    k = (k + step) % n;
    if (!shape_.fits(axis, 2 * std::numbers::pi * k / n, reach)) return k;
  }
  return 0;
}

bool AxisLadders::fits_odd_angles(const SymmetryAxis& axis, double reach) const {
  return std::all_of(kOddAngles.begin(), kOddAngles.end(), [&](double share) {
    return shape_.fits(axis, 2 * std::numbers::pi * share, reach);
  });
}

// Of a shape that all angles fit: the folds that fit much better than an odd angle.
std::vector<std::int32_t> AxisLadders::outstanding(const SymmetryAxis& axis,
                                                   const std::vector<std::int32_t>& folds,
                                                   double cap) const {
  constexpr std::size_t kSamples = 1000;  // points: means are compared to a factor of four
  const auto mean = [&](double share) {
    return shape_.mean_error(axis, 2 * std::numbers::pi * share, cap, kSamples);
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

void AxisLadders::judge(AxisLadder& ladder, double tolerance) const {
  for (FoldCandidate& c : ladder.folds) {
    c.accepted = c.error_rel * diameter_ <= tolerance;
    c.ruled_out = false;
    double divisors = kInfinity;
    for (const FoldCandidate& o : ladder.folds) {
      if (o.fold == c.fold) continue;
      const bool divides = c.fold % o.fold == 0, multiple = o.fold % c.fold == 0;
      if (!divides && !multiple && std::max(o.error_rel, kNoiseRel) < c.error_rel / kDominance) {
        c.ruled_out = true;
      }
      if (divides) divisors = std::min(divisors, std::max(o.error_rel, kNoiseRel));
    }
    if (divisors < kInfinity && c.error_rel > std::max(kAcceptedAnyway, kDominance * divisors)) {
      c.ruled_out = true;
    }
  }
  ladder.fold = 1;
  ladder.error = 0;
  for (const FoldCandidate& c : ladder.folds) {
    if (!c.accepted || c.ruled_out) continue;
    ladder.fold = c.fold;
    ladder.error = c.error_rel * diameter_;
  }
}

// Those not known to fit whose turns all pass a quick look.
std::vector<std::int32_t> AxisLadders::near_folds(const AxisLadder& ladder,
                                                  double tolerance,
                                                  double reach) const {
  std::vector<std::int32_t> folds;
  for (std::int32_t n = 2; n <= kMostNearFold; ++n) {
    const auto known = std::find_if(ladder.folds.begin(), ladder.folds.end(),
                                    [n](const FoldCandidate& c) { return c.fold == n; });
    const bool fits = known != ladder.folds.end() && known->error_rel * diameter_ <= tolerance;
    // A divisor of what fits, fits.
    if (!fits && ladder.fold % n != 0 && shape_.fits(ladder.axis, angle_of(n), reach)) {
      folds.push_back(n);
    }
  }
  if (folds.size() > kManyFolds) folds = outstanding(ladder.axis, folds, reach);
  std::erase_if(folds, [&](std::int32_t n) { return misfitting_turn(ladder.axis, n, reach) > 0; });
  if (folds.size() > kManyFolds) folds.erase(folds.begin(), folds.end() - kManyFolds);
  return folds;
}

Result<void> AxisLadders::widen(const SymmetryAxis& candidate,
                                double tolerance,
                                AxisLadder& ladder) const {
  const double reach = reach_of(tolerance, diameter_);
  const std::vector<std::int32_t> folds =
      reach > tolerance ? near_folds(ladder, tolerance, reach) : std::vector<std::int32_t>{};
  // Measured to a smaller bound, the errors beyond it are not the largest.
  std::erase_if(ladder.turns,
                [&](const auto& turn) { return turn.second.distance > 4 * tolerance; });
  std::erase_if(ladder.folds,
                [&](const FoldCandidate& c) { return c.error_rel * diameter_ > tolerance; });
  struct Near {
    FoldCandidate rung;
    SymmetryAxis axis;
  };
  std::vector<Near> found;
  int refinements = 0;
  for (auto n = folds.rbegin(); n != folds.rend(); ++n) {
    auto error = measure(ladder, *n, 1, *n - 1, reach);
    if (!error) return error_of(error);
    if (error->distance > reach) continue;
    SymmetryAxis axis = ladder.axis;
    // Smaller folds matter only where they might be accepted if given.
    const bool matters = *n > ladder.fold || error->distance <= kWorthRefining * tolerance;
    if (matters && ++refinements <= kMostRefined) {
      const SymmetryAxis own = refined(candidate, *n, tolerance);
      auto better = shape_.error(own, *n, error->distance, context_);
      if (!better) return error_of(better);
      if (better->distance < error->distance) {
        *error = *better;
        axis = own;
      }
    }
    found.push_back({{*n, error->distance / diameter_, false, error->worst}, axis});
  }
  for (const Near& near : found) {
    const auto place = std::find_if(ladder.folds.begin(), ladder.folds.end(),
                                    [&](const auto& c) { return c.fold > near.rung.fold; });
    ladder.folds.insert(place, near.rung);
  }
  judge(ladder, tolerance);
  for (const Near& near : found) {
    if (near.rung.fold == ladder.fold) ladder.axis = near.axis;
  }
  return {};
}

Result<bool> AxisLadders::takes(const SymmetryAxis& candidate,
                                std::int32_t fold,
                                double error,
                                double tolerance) const {
  auto ladder = climb(candidate, tolerance);
  if (!ladder) return error_of(ladder);
  if (ladder->revolution) return false;
  if (ladder->fold == fold) return true;
  // Not about that axis, but about its own.
  std::erase_if(ladder->folds, [&](const FoldCandidate& c) { return c.fold == fold; });
  const auto place = std::find_if(ladder->folds.begin(), ladder->folds.end(),
                                  [&](const auto& c) { return c.fold > fold; });
  ladder->folds.insert(place, {fold, error / diameter_, false});
  judge(*ladder, tolerance);
  return ladder->fold == fold;
}

Result<AxisLadders::Revolution> AxisLadders::revolution(const SymmetryAxis& candidate,
                                                        double tolerance,
                                                        double enough) const {
  constexpr std::int32_t kParts = 1000;
  // An odd angle determines the axis of what has no fold.
  const double angle = 2 * std::numbers::pi * kOddAngles.front();
  Revolution result;
  result.axis = refined_by(angle, candidate, tolerance);
  result.error = kInfinity;
  if (!fits_odd_angles(result.axis, enough)) return result;
  double worst = 0;
  for (const double share : kOddAngles) {
    const auto steps = static_cast<std::int32_t>(std::round(share * kParts));
    const auto error = shape_.turn_error(result.axis, steps, kParts, enough, context_);
    if (!error) return error_of(error);
    worst = std::max(worst, error->distance);
  }
  if (worst <= enough) result.error = worst;
  return result;
}

}  // namespace symcell::solid
