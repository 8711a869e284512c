#include "core/plane/symmetry/symmetrise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/index.hpp"
#include "core/cell/inspection.hpp"
#include "core/geometry/limits.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/model/describe.hpp"
#include "core/plane/input/open_contours.hpp"
#include "core/plane/symmetry/close_fold.hpp"
#include "core/plane/symmetry/fold_detection.hpp"
#include "core/plane/symmetry/prepared_pslg.hpp"
#include "core/plane/symmetry/symmetrise_subdomains.hpp"

namespace symcell::plane {
namespace {

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
              const Subdomains& subdomains,
              const MeshOptions& options,
              const PreparedPslg& prepared,
              ExecutionContext& context)
      : pslg_(pslg),
        subdomains_(subdomains),
        options_(options),
        context_(context),
        prepared_(prepared),
        index_(positions_of(prepared)),
        tolerance_(options.symmetry_tolerance_rel.value_or(kExactSymmetryToleranceRel) *
                   prepared.diameter),
        detector_(prepared, index_, tolerance_, given_centre()) {}

  Result<SymmetricPslg> run(std::vector<FoldFit>* ladder) {
    if (options_.fold == 1) return without_symmetry();
    if (options_.fold) return declared(*options_.fold);
    auto fits = detector_.ladder(reach(), context_);
    if (!fits) return error_of(fits);
    auto symmetric = largest(prepared_, *fits, 1);
    if (!symmetric) return error_of(symmetric);
    auto result = *symmetric ? Result<SymmetricPslg>(std::move(**symmetric)) : without_symmetry();
    if (!result) return result;
    result->fold_detected = true;
    result->geometry_fold = result->fold;
    SYMCELL_TRY(warn(*fits, *result));
    SYMCELL_TRY(set_attributes_aside(*result));
    if (result->geometry_fold == 1) {
      result->warnings.push_back(no_symmetry_warning(tolerance_ / prepared_.diameter));
    }
    if (ladder != nullptr) *ladder = completed(std::move(*fits), result->fold);
    return result;
  }

 private:
  Result<SymmetricPslg> without_symmetry() {
    return close(1, options_.center ? *options_.center : plain_centre(prepared_));
  }

  // Of the largest fold above `least` that is kept, fits and can be closed; nothing if none does.
  // Afterwards `fits` keeps no larger one that fits.
  Result<std::optional<SymmetricPslg>> largest(const PreparedPslg& prepared,
                                               std::vector<FoldFit>& fits,
                                               std::int32_t least) {
    for (auto fit = fits.rbegin(); fit != fits.rend() && fit->fold > least; ++fit) {
      if (!fit->kept || fit->error > tolerance_) continue;
      auto result = close_fold(pslg_, options_, prepared, index_,
                               {fit->fold, fit->centre, tolerance_}, context_);
      if (result) return std::optional<SymmetricPslg>(std::move(*result));
      if (result.error().code != ErrorCode::kNotSymmetric) return error_of(result);
      fit->kept = false;
    }
    return std::optional<SymmetricPslg>();
  }

  [[nodiscard]] double reach() const {
    constexpr double kMostToleranceRel = 0.1;  // that can be given
    return std::max(tolerance_,
                    std::min(kNearTolerances * tolerance_, kMostToleranceRel * prepared_.diameter));
  }

  // Of the folds that only a larger tolerance takes, the largest; each with the smallest tolerance.
  Result<void> warn(const std::vector<FoldFit>& fits, SymmetricPslg& result) {
    constexpr std::size_t kMostNear = 3;  // reported
    constexpr int kMostTried = 3;         // each is closed
    const double given = tolerance_ / prepared_.diameter;
    int tried = 0;
    for (auto fit = fits.rbegin(); fit != fits.rend() && fit->fold > result.fold; ++fit) {
      if (!fit->kept || fit->error <= tolerance_) continue;
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
      if (is_cheap(fit->fold)) {
        ++tried;
        const auto closed =
            close_fold(pslg_, options_, prepared_, index_,
                       {fit->fold, fit->centre, fold.tolerance_rel * prepared_.diameter}, context_);
        if (!closed && is_limit(closed.error().code)) return error_of(closed);
        if (!closed) continue;
      }
      result.warnings.push_back(near_symmetry_warning(fold, result.fold, given));
    }
    return {};
  }

  [[nodiscard]] bool has_attributes() const {
    if (prepared_.ignore_markers) return false;
    const PreparedEdge& first = prepared_.edges.front();
    const std::int32_t kind = std::max(first.left, first.right);
    const auto other = [kind](std::int32_t c) { return c != 0 && c != kind; };
    return std::any_of(prepared_.edges.begin(), prepared_.edges.end(), [&](const PreparedEdge& e) {
      return e.marker != first.marker || other(e.left) || other(e.right);
    });
  }

  // What the fold of the geometry is, if markers and region attributes are all that breaks it.
  Result<void> set_attributes_aside(SymmetricPslg& result) {
    if (!has_attributes()) return {};
    const PreparedPslg geometry = prepare_pslg(pslg_, subdomains_, true);
    const FoldDetector detector(geometry, index_, tolerance_, given_centre());
    auto fits = detector.ladder(tolerance_, context_);
    if (!fits) return error_of(fits);
    const auto larger = largest(geometry, *fits, result.fold);
    if (!larger) return error_of(larger);
    if (!*larger) return {};
    result.geometry_fold = (*larger)->fold;
    result.warnings.push_back(markers_break_symmetry_warning(
        result.fold, result.geometry_fold,
        broken_attributes(result.geometry_fold, (*larger)->centre).text));
    return {};
  }

  // A pair of segments that are images of each other and differ in what they carry.
  struct Difference {
    std::string text;
    std::vector<std::int64_t> segments;
  };
  [[nodiscard]] Difference broken_attributes(std::int32_t fold, Point2 centre) const {
    const double angle = 2 * std::numbers::pi / fold;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const auto image = [&](Point2 p) {
      const Point2 q = p - centre;
      return Point2{centre.x + cosine * q.x - sine * q.y, centre.y + sine * q.x + cosine * q.y};
    };
    for (const PreparedEdge& edge : prepared_.edges) {
      const Point2 a = prepared_.points[at(edge.a)], b = prepared_.points[at(edge.b)];
      const SegmentIndex::Hit hit = index_.nearest(image(a + 0.5 * (b - a)), prepared_.diameter);
      if (hit.segment < 0) continue;
      const PreparedEdge& other = prepared_.edges[at(hit.segment)];
      const Point2 u = image(b) - image(a);
      const Point2 w = prepared_.points[at(other.b)] - prepared_.points[at(other.a)];
      const bool same_way = dot(u, w) >= 0;
      const std::string pair = "segments " + std::to_string(edge.segment) + " and " +
                               std::to_string(other.segment) + ", which are images of each other,";
      if (edge.marker != other.marker) {
        return {pair + " have markers " + std::to_string(edge.marker) + " and " +
                    std::to_string(other.marker),
                {edge.segment, other.segment}};
      }
      if (edge.left != (same_way ? other.left : other.right) ||
          edge.right != (same_way ? other.right : other.left)) {
        return {pair + " have regions beside them that differ in attribute or max_area",
                {edge.segment, other.segment}};
      }
    }
    return {};
  }

  // Whether a fold may be closed only to tell what would come of it: where all else fails, every
  // sector gets the vertices of all.
  [[nodiscard]] bool is_cheap(std::int32_t fold) const {
    constexpr double kMostCopies = 50'000;  // of vertices: tens of milliseconds
    return static_cast<double>(prepared_.points.size()) * fold <= kMostCopies;
  }

  // What giving each fold would lead to.
  std::vector<FoldFit> completed(std::vector<FoldFit> fits, std::int32_t taken) {
    constexpr int kMostTried = 12;  // each is closed
    int tried = 0;
    for (auto fit = fits.rbegin(); fit != fits.rend(); ++fit) {
      // A divisor of what is symmetric is.
      fit->accepted = taken % fit->fold == 0;
      if (fit->accepted || fit->error > 2 * tolerance_) continue;
      const bool try_it = is_cheap(fit->fold) && ++tried <= kMostTried;
      fit->accepted = try_it ? close(fit->fold, fit->centre).has_value()
                             : fit->kept && fit->error <= tolerance_;
    }
    return fits;
  }

  [[nodiscard]] const Point2* given_centre() const {
    return options_.center ? &*options_.center : nullptr;
  }

  Result<SymmetricPslg> declared(std::int32_t fold) {
    const FoldFit fit = detector_.fit(fold);
    auto result = close(fold, fit.centre);
    if (result || result.error().code != ErrorCode::kNotSymmetric) return result;
    const double limit = options_.symmetry_tolerance_rel.value_or(kExactSymmetryToleranceRel);
    const std::string name = std::to_string(fold) + "-fold symmetric";
    if (auto only = broken_by_attributes(fold, name)) return fail(std::move(*only));
    std::string message = "the model is not " + name + " about " + describe_point(fit.centre) +
                          " within the tolerance of " + describe_rounded(limit) +
                          " of its diameter: ";
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

  // The error of a fold that the geometry has, but not with its markers and attributes.
  std::optional<Error> broken_by_attributes(std::int32_t fold, const std::string& name) {
    if (!has_attributes()) return std::nullopt;
    const PreparedPslg geometry = prepare_pslg(pslg_, subdomains_, true);
    const FoldFit fit = FoldDetector(geometry, index_, tolerance_, given_centre()).fit(fold);
    if (fit.error > 2 * tolerance_) return std::nullopt;
    const auto closed =
        close_fold(pslg_, options_, geometry, index_, {fold, fit.centre, tolerance_}, context_);
    if (!closed) return std::nullopt;
    Difference difference = broken_attributes(fold, closed->centre);
    if (difference.segments.empty()) return std::nullopt;
    return Error{
        ErrorCode::kNotSymmetric,
        "the geometry is " + name + ", markers and region attributes are not: " + difference.text +
            "; give ignore_markers=true to set markers and attributes aside, or correct them",
        difference.segments, "/segments/" + std::to_string(difference.segments.front())};
  }

  Result<SymmetricPslg> close(std::int32_t fold, Point2 centre) {
    return close_fold(pslg_, options_, prepared_, index_, {fold, centre, tolerance_}, context_);
  }

  const Pslg& pslg_;
  const Subdomains& subdomains_;
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
  auto result = Symmetriser(pslg, subdomains, options, prepared, context).run(ladder);
  if (result && result->copied_vertices > 0) {
    result->warnings.push_back(vertices_copied_warning(result->fold, result->copied_vertices));
  }
  if (!result) return result;
  const OpenContours open = find_open_contours(pslg, subdomains);
  if (open.left_out > 0) {
    result->warnings.push_back(segments_left_out_warning(open.left_out, open.left_out_at));
  }
  if (!open.inside.empty()) {
    result->warnings.push_back(
        open_contour_warning(open.inside.size(), describe_loose_ends(pslg, open.inside.front())));
  }
  return result;
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
