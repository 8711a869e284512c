#include "core/plane/symmetry/symmetrise.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/cell/inspection.hpp"
#include "core/geometry/limits.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/geometry/rotation.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/model/describe.hpp"
#include "core/plane/symmetry/fold_detection.hpp"
#include "core/plane/symmetry/lifted_check.hpp"
#include "core/plane/symmetry/orbit_closure.hpp"
#include "core/plane/symmetry/prepared_pslg.hpp"
#include "core/plane/symmetry/symmetrise_subdomains.hpp"

namespace symcell::plane {
namespace {

// Share of the diameter within which a vertex and an image of another are a near miss for whoever
// compares a mesh with its model.
constexpr double kNearMissRel = 1e-5;

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

Result<void> check_options(const MeshOptions& options) {
  if (options.fold && (*options.fold < 1 || *options.fold > kMaxFold)) {
    return fail(ErrorCode::kBadFold,
                "fold " + std::to_string(*options.fold) + " is not between 1 and " +
                    std::to_string(kMaxFold) + "; give the number of equal sectors, or auto",
                {}, "/options/fold");
  }
  if (options.center && !(std::abs(options.center->x) <= kMaxCoordinate &&
                          std::abs(options.center->y) <= kMaxCoordinate)) {
    return fail(ErrorCode::kBadAxis,
                "the centre " + describe_point(*options.center) +
                    " is not finite or out of range; give finite coordinates, or leave it out",
                {}, "/options/center");
  }
  return {};
}

std::vector<IndexedSegment> positions_of(const PreparedPslg& prepared) {
  std::vector<IndexedSegment> result;
  result.reserve(prepared.edges.size());
  for (const PreparedEdge& edge : prepared.edges) {
    result.push_back({prepared.points[at(edge.a)], prepared.points[at(edge.b)]});
  }
  return result;
}

// The centre of a mesh without symmetry only fixes the origin of its coordinates. Far from the
// origin a coarse multiple of a power of two near the middle: then subtracting it is exact.
Point2 plain_centre(const PreparedPslg& prepared) {
  const Point2 middle = prepared.box_low + 0.5 * (prepared.box_high - prepared.box_low);
  const double step = std::exp2(std::ceil(std::log2(prepared.diameter)));
  const auto coarse = [step](double x) {
    return std::abs(x) < 4 * step ? 0.0 : step * std::round(x / step);
  };
  return {coarse(middle.x), coarse(middle.y)};
}

class Symmetriser {
 public:
  Symmetriser(const Pslg& pslg,
              const MeshOptions& options,
              const PreparedPslg& prepared,
              ExecutionContext& context)
      : pslg_(pslg),
        options_(options),
        context_(context),
        prepared_(prepared),
        index_(positions_of(prepared)),
        tolerance_(options.symmetry_tolerance_rel.value_or(kExactSymmetryToleranceRel) *
                   prepared.diameter),
        detector_(prepared, index_, tolerance_, options.center ? &*options.center : nullptr) {}

  Result<SymmetricPslg> run(std::vector<FoldFit>* ladder) {
    if (options_.fold == 1) return without_symmetry();
    if (options_.fold) return declared(*options_.fold);
    auto fits = detector_.ladder(context_);
    if (!fits) return error_of(fits);
    auto result = largest(*fits);
    if (!result) return result;
    const auto near = detector_.near(*fits, reach(), context_);
    if (!near) return error_of(near);
    SYMCELL_TRY(warn(*near, *result));
    if (ladder != nullptr) *ladder = completed(std::move(*fits), *near, result->fold);
    return result;
  }

 private:
  Result<SymmetricPslg> without_symmetry() {
    return close(1, options_.center ? *options_.center : plain_centre(prepared_));
  }

  // Of the largest fold that is kept and can be closed; `fits` keeps no larger one.
  Result<SymmetricPslg> largest(std::vector<FoldFit>& fits) {
    for (auto fit = fits.rbegin(); fit != fits.rend(); ++fit) {
      if (!fit->kept) continue;
      auto result = close(fit->fold, fit->centre);
      if (result) {
        result->fold_detected = true;
        return result;
      }
      if (result.error().code != ErrorCode::kNotSymmetric) return result;
      fit->kept = false;
    }
    auto result = without_symmetry();
    if (result) result->fold_detected = true;
    return result;
  }

  [[nodiscard]] double reach() const {
    constexpr double kMostToleranceRel = 0.1;  // that can be given
    return std::max(tolerance_,
                    std::min(kNearTolerances * tolerance_, kMostToleranceRel * prepared_.diameter));
  }

  // Of the folds that only a larger tolerance takes, the largest; each with the smallest tolerance.
  Result<void> warn(const std::vector<FoldFit>& near, SymmetricPslg& result) {
    constexpr std::size_t kMostNear = 3;  // reported
    constexpr int kMostTried = 5;         // each is closed
    const double given = tolerance_ / prepared_.diameter;
    int tried = 0;
    for (auto fit = near.rbegin(); fit != near.rend() && fit->fold > result.fold; ++fit) {
      if (fit->error <= tolerance_) continue;
      if (result.warnings.size() == kMostNear || tried == kMostTried) break;
      const double error = fit->error / prepared_.diameter;
      const NearFold fold{fit->fold, error, tolerance_that_takes(error)};
      // Not if more tolerance is wanted for less.
      const bool of_use =
          std::all_of(result.warnings.begin(), result.warnings.end(), [&](const Warning& w) {
            const double share = w.near_fold->fold % fold.fold == 0 ? 0.5 : 1;
            return fold.tolerance_rel < share * w.near_fold->tolerance_rel;
          });
      if (!of_use) continue;
      ++tried;
      MeshOptions wider = options_;
      wider.symmetry_tolerance_rel = fold.tolerance_rel;
      Symmetriser other(pslg_, wider, prepared_, context_);
      auto fits = other.detector_.ladder(context_);
      if (!fits) return error_of(fits);
      const auto found = other.largest(*fits);
      if (!found && is_limit(found.error().code)) return error_of(found);
      if (!found || found->fold != fold.fold) continue;
      result.warnings.push_back(near_symmetry_warning(fold, result.fold, given));
    }
    if (result.fold == 1) result.warnings.push_back(no_symmetry_warning(given));
    return {};
  }

  // Both lists as one, with what giving each fold would lead to.
  std::vector<FoldFit> completed(std::vector<FoldFit> fits,
                                 const std::vector<FoldFit>& near,
                                 std::int32_t taken) {
    constexpr int kMostTried = 12;  // each is closed
    std::erase_if(fits, [&](const FoldFit& f) { return f.error > tolerance_; });
    fits.insert(fits.end(), near.begin(), near.end());
    std::sort(fits.begin(), fits.end(),
              [](const FoldFit& a, const FoldFit& b) { return a.fold < b.fold; });
    int tried = 0;
    for (FoldFit& fit : fits) {
      // A divisor of what is symmetric is.
      fit.accepted = taken % fit.fold == 0;
      if (fit.accepted || fit.error > 2 * tolerance_) continue;
      fit.accepted = ++tried > kMostTried ? fit.kept : declared(fit.fold).has_value();
    }
    return fits;
  }

  Result<SymmetricPslg> declared(std::int32_t fold) {
    const FoldFit fit = detector_.fit(fold);
    auto result = close(fold, fit.centre);
    if (result || result.error().code != ErrorCode::kNotSymmetric) return result;
    const double limit = options_.symmetry_tolerance_rel.value_or(kExactSymmetryToleranceRel);
    std::string message = "the model is not " + std::to_string(fold) + "-fold symmetric about " +
                          describe_point(fit.centre) + " within the tolerance of " +
                          describe_rounded(limit) + " of its diameter: ";
    Error error = result.error();
    // An infinite error means that only kinds differ; the closure names them.
    if (fit.error > tolerance_ && std::isfinite(fit.error) && fit.worst_point >= 0) {
      const std::int32_t vertex = prepared_.input_vertex[at(fit.worst_point)];
      message += "error " + describe_rounded(fit.error / prepared_.diameter) +
                 " of the diameter, worst at " + describe_vertex(pslg_.vertices, vertex);
      error.elements = {vertex};
      error.pointer = "/vertices/" + std::to_string(vertex);
    } else {
      message += error.message;
    }
    error.message = message + "; correct the model, the fold or the centre, or raise the tolerance";
    return fail(std::move(error));
  }

  // Links copies as tightly as succeeds: a wide link would merge vertices that only lie close. But
  // where a tight one gives vertices copies that the model lacks, some of those may stand beside
  // others that were meant, by less than the tolerance: then the widest that needs the fewest.
  Result<SymmetricPslg> close(std::int32_t fold, Point2 centre) {
    const double finest = std::min(prepared_.resolution(), 2 * tolerance_);
    std::optional<SymmetricPslg> best;
    for (double link = finest;; link = std::min(1000 * link, 2 * tolerance_)) {
      auto result = close_linked({fold, centre, link, std::max(tolerance_, finest)});
      if (result) {
        if (!best || result->orbit_points.size() < best->orbit_points.size()) {
          best = std::move(*result);
        }
      } else if (is_limit(result.error().code) ||
                 (!best && result.error().code != ErrorCode::kNotSymmetric)) {
        return result;
      }
      if (best && (fold == 1 || !adds_vertices(*best))) return std::move(*best);
      if (fold == 1 || link >= 2 * tolerance_) {
        if (!best) return result;
        if (options_.symmetry_tolerance_rel.has_value() || !has_copies_beside_vertices(*best)) {
          return std::move(*best);
        }
        return fail(ErrorCode::kNotSymmetric,
                    "vertices have copies that stand beside others and are near misses of them");
      }
    }
  }

  [[nodiscard]] bool adds_vertices(const SymmetricPslg& pslg) const {
    const std::size_t centre = pslg.centre_orbit >= 0 ? 1 : 0;
    const std::size_t all =
        (pslg.orbit_points.size() - centre) * static_cast<std::size_t>(pslg.fold) + centre;
    return all > prepared_.points.size() + 1;  // a centre may be new, cut into a segment
  }

  // Whether positions that are but a near miss of each other would be several vertices of the result
  // and are one of the model: no mesh of such spots can be distinguished from a wrong one.
  [[nodiscard]] bool has_copies_beside_vertices(const SymmetricPslg& pslg) const {
    const RotationTable rotations(pslg.fold);
    std::vector<Point3> lifted, given;
    for (std::size_t v = 0; v < pslg.orbit_points.size(); ++v) {
      const bool centre = static_cast<std::int32_t>(v) == pslg.centre_orbit;
      for (std::int32_t k = 0; k < (centre ? 1 : pslg.fold); ++k) {
        const Point2 p = rotations.rotate(pslg.orbit_points[v], k);
        lifted.push_back({p.x, p.y, 0});
      }
    }
    for (const Point2 p : prepared_.points) {
      given.push_back({p.x - pslg.centre.x, p.y - pslg.centre.y, 0});
    }
    const PointTree all(lifted), model(given);
    // On either side of what counts as a near miss vertices may have been moved by the tolerance.
    const double side = kNearMissRel * prepared_.diameter + 2 * tolerance_;
    const Point3 reach{side, side, 0};
    return std::any_of(given.begin(), given.end(), [&](const Point3& p) {
      std::int64_t more = 0;
      all.within_box(p - reach, p + reach, [&](std::int32_t) { ++more; });
      model.within_box(p - reach, p + reach, [&](std::int32_t) { --more; });
      return more > 0;
    });
  }

  Result<SymmetricPslg> close_linked(ClosureRequest request) {
    auto closed = close_orbits(prepared_, index_, request, context_);
    if (!closed) return error_of(closed);
    const bool settled = length(closed->centre_shift) <= 1e-3 * prepared_.resolution();
    if (request.fold > 1 && !options_.center && !settled) {
      ClosureRequest moved = request;
      moved.centre = request.centre + closed->centre_shift;
      auto again = close_orbits(prepared_, index_, moved, context_);
      if (again && again->pslg.symmetry_error_rel <= closed->pslg.symmetry_error_rel) {
        closed = std::move(again);
      }
    }
    SymmetricPslg& result = closed->pslg;
    result.diameter = prepared_.diameter;
    result.centre_detected = !options_.center;
    copy_seeds(result);
    SYMCELL_TRY(check_and_seed(*closed, context_));
    return std::move(result);
  }

  void copy_seeds(SymmetricPslg& result) const {
    for (const Point2 hole : pslg_.holes) result.holes.push_back(hole - result.centre);
    for (PslgRegion region : pslg_.regions) {
      region.point = region.point - result.centre;
      result.regions.push_back(region);
    }
  }

  const Pslg& pslg_;
  const MeshOptions& options_;
  ExecutionContext& context_;
  const PreparedPslg& prepared_;
  SegmentIndex index_;
  double tolerance_;
  FoldDetector detector_;
};

}  // namespace

Result<SymmetricPslg> symmetrise_subdomains(const Pslg& pslg,
                                            const Subdomains& subdomains,
                                            const MeshOptions& options,
                                            std::vector<FoldFit>* ladder,
                                            ExecutionContext& context) {
  SYMCELL_TRY(check_options(options));
  const PreparedPslg prepared = prepare_pslg(pslg, subdomains, options.ignore_markers);
  if (prepared.edges.empty()) {
    return fail(ErrorCode::kDegenerateGeometry, "the segments enclose nothing to mesh");
  }
  context.report(Phase::kSymmetry, 0.04);
  return Symmetriser(pslg, options, prepared, context).run(ladder);
}

Result<SymmetricPslg> symmetrise(const Pslg& pslg,
                                 const MeshOptions& options,
                                 ExecutionContext& context) {
  SYMCELL_TRY(check_options(options));
  context.report(Phase::kSymmetry, 0.01);
  const auto subdomains = make_subdomains(pslg, context);
  if (!subdomains) return error_of(subdomains);
  return symmetrise_subdomains(pslg, *subdomains, options, nullptr, context);
}

}  // namespace symcell::plane
