#include "core/plane/symmetry/close_fold.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "core/geometry/point_tree.hpp"
#include "core/geometry/rotation.hpp"
#include "core/plane/symmetry/lifted_check.hpp"
#include "core/plane/symmetry/orbit_closure.hpp"
#include "core/plane/symmetry/sector_outline.hpp"

namespace symcell::plane {
namespace {

// Share of the diameter within which a vertex and an image of another are a near miss for whoever
// compares a mesh with its model.
constexpr double kNearMissRel = 1e-5;
// Moves of vertices up to this share of the diameter are noise.
constexpr double kSurelyCopiesRel = 1e-5;
// By how much the distance grows at which copies are linked, from try to try.
constexpr double kLinkGrowth = 1000;

class Closer {
 public:
  Closer(const Pslg& pslg,
         const MeshOptions& options,
         const PreparedPslg& prepared,
         const SegmentIndex& index,
         const FoldRequest& request,
         ExecutionContext& context)
      : pslg_(pslg),
        options_(options),
        context_(context),
        prepared_(prepared),
        index_(index),
        request_(request),
        tolerance_(request.tolerance) {}

  Result<SymmetricPslg> run() {
    if (request_.fold == 1 || options_.keep_vertices) return with_all_vertices();
    auto permuted = with_permuted_vertices();
    if (!permuted && is_limit(permuted.error().code)) return permuted;
    // Far from their copies, vertices may have been taken for copies of their neighbours.
    if (permuted && permuted->symmetry_error_rel <= kSurelyCopiesRel) return permuted;
    auto outline = with_one_outline();
    if (!outline && is_limit(outline.error().code)) return outline;
    if (permuted && outline) {
      const bool better = 2 * outline->symmetry_error_rel < permuted->symmetry_error_rel;
      return better ? outline : permuted;
    }
    if (permuted) return permuted;
    if (outline) return outline;
    auto all = with_all_vertices();
    if (all && adds_vertices(*all)) all->copied_vertices = all_of(*all) - prepared_.points.size();
    return all;
  }

 private:
  [[nodiscard]] double finest_link() const {
    return std::min(prepared_.resolution(), 2 * tolerance_);
  }

  // Where each vertex has all its copies: links these as tightly as succeeds.
  Result<SymmetricPslg> with_permuted_vertices() {
    const double finest = finest_link();
    for (double link = finest;; link = std::min(kLinkGrowth * link, 2 * tolerance_)) {
      auto result =
          closed({request_.fold, request_.centre, link, std::max(tolerance_, finest), false},
                 close_orbits);
      if (result && all_of(*result) < prepared_.points.size()) {
        result = fail(ErrorCode::kNotSymmetric, "vertices that are not copies of each other merge");
      }
      const bool last = link >= 2 * tolerance_;
      if (result || last || result.error().code != ErrorCode::kNotSymmetric) return result;
    }
  }

  Result<SymmetricPslg> with_one_outline() {
    const double tolerance = std::max(tolerance_, prepared_.resolution());
    auto result =
        closed({request_.fold, request_.centre, finest_link(), tolerance, true}, outline_sector);
    if (result) result->shape_tolerance_rel = tolerance / prepared_.diameter;
    return result;
  }

  [[nodiscard]] static std::size_t all_of(const SymmetricPslg& pslg) {
    const std::size_t centre = pslg.centre_orbit >= 0 ? 1 : 0;
    return (pslg.orbit_points.size() - centre) * static_cast<std::size_t>(pslg.fold) + centre;
  }

  // Links copies as tightly as succeeds: a wide link would merge vertices that only lie close. But
  // where a tight one gives vertices copies that the model lacks, some of those may stand beside
  // others that were meant, by less than the tolerance: then the widest that needs the fewest.
  Result<SymmetricPslg> with_all_vertices() {
    const std::int32_t fold = request_.fold;
    const double finest = finest_link();
    std::optional<SymmetricPslg> best;
    for (double link = finest;; link = std::min(kLinkGrowth * link, 2 * tolerance_)) {
      auto result =
          closed({fold, request_.centre, link, std::max(tolerance_, finest), true}, close_orbits);
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
    return all_of(pslg) > prepared_.points.size() + 1;  // a centre may be new, cut into a segment
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

  // By the given way, and again about the centre that this finds, where that is better.
  template <class Way>
  Result<SymmetricPslg> closed(const ClosureRequest& request, const Way& way) {
    auto closed = way(prepared_, index_, request, context_);
    if (!closed) return error_of(closed);
    const bool settled = length(closed->centre_shift) <= 1e-3 * prepared_.resolution();
    if (request.fold > 1 && !options_.center && !settled) {
      ClosureRequest moved = request;
      moved.centre = request.centre + closed->centre_shift;
      auto again = way(prepared_, index_, moved, context_);
      if (again && again->pslg.symmetry_error_rel <= closed->pslg.symmetry_error_rel) {
        closed = std::move(again);
      }
    }
    SymmetricPslg& result = closed->pslg;
    result.diameter = prepared_.diameter;
    result.centre_detected = !options_.center;
    copy_seeds(result);
    SYMCELL_TRY(check_and_seed(*closed, context_));
    if (result.symmetry_error_rel > kExactSymmetryToleranceRel) {
      result.shape_tolerance_rel = request.tolerance / prepared_.diameter;
    }
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
  const SegmentIndex& index_;
  const FoldRequest& request_;
  double tolerance_;
};

}  // namespace

Result<SymmetricPslg> close_fold(const Pslg& pslg,
                                 const MeshOptions& options,
                                 const PreparedPslg& prepared,
                                 const SegmentIndex& index,
                                 const FoldRequest& request,
                                 ExecutionContext& context) {
  return Closer(pslg, options, prepared, index, request, context).run();
}

}  // namespace symcell::plane
