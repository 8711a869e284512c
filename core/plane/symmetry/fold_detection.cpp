#include "core/plane/symmetry/fold_detection.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/base/index.hpp"
#include "core/cell/inspection.hpp"

namespace symcell::plane {
namespace {

// Points that folds are tested by, half of them the rarest.
constexpr std::size_t kMaxSamples = 2000;
// Searches of the nearest segment, about a microsecond each: for a fold that is given, and for all
// the folds of a ladder together, with the least and the most for each.
constexpr std::int64_t kSearchesGiven = 50'000;
constexpr std::int64_t kSearchesLadder = 60'000;
constexpr std::int64_t kFewestSearches = 1'000;
constexpr std::int64_t kMostSearches = 20'000;
// How far off the centroid may be as a centre, at a first look.
constexpr double kCentroidTolerances = 4;
// A fold stands out if its error is below that of an arbitrary angle by this factor.
constexpr double kDominance = 4;
constexpr std::ptrdiff_t kMostFolds = 64;  // of a ladder: the largest
// Shares of the diameter by which the radii of vertices on one circle may differ.
constexpr double kRadiusGaps[] = {1e-12, 1e-10, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
// By it samples are ranked, whatever the tolerance.
constexpr double kRankGapRel = 1e-4;
constexpr std::int32_t kAlwaysTried = 12;  // folds that need no circle of vertices to suggest them
// Turns by which a fold is looked at first, as shares of the full turn: far from each other and from
// the small ones, which move nothing far.
constexpr double kFirstTurns[] = {0.382, 0.5, 0.276, 0.146};
// Looks at samples for folds that no circle of vertices suggests: below a tenth of a second.
constexpr std::int64_t kMostLooks = 60'000;
constexpr std::size_t kFirstSamples[] = {4, 32, 256, kMaxSamples};

Point2 turn(Point2 p, Point2 centre, double cosine, double sine) {
  const Point2 q = p - centre;
  return {centre.x + cosine * q.x - sine * q.y, centre.y + sine * q.x + cosine * q.y};
}

std::vector<IndexedSegment> isolated_points(const PreparedPslg& prepared) {
  std::vector<char> used(prepared.points.size(), 0);
  for (const PreparedEdge& edge : prepared.edges) used[at(edge.a)] = used[at(edge.b)] = 1;
  std::vector<IndexedSegment> result;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) result.push_back({prepared.points[i], prepared.points[i]});
  }
  return result;
}

// Multiples of the turn to test: all of them where that is cheap, else a spread.
std::vector<std::int32_t> multiples(std::int32_t fold, std::int64_t affordable) {
  const std::int64_t all = fold - 1;
  std::vector<std::int32_t> result;
  if (all <= affordable) {
    result.resize(static_cast<std::size_t>(all));
    std::iota(result.begin(), result.end(), 1);
    return result;
  }
  // Spread by the golden section, so that the first few are large and far from each other already.
  for (std::int64_t i = 1; i <= affordable; ++i) {
    const double share = static_cast<double>(i) * (std::numbers::phi - 1);
    const double part = share - std::floor(share);
    result.push_back(static_cast<std::int32_t>(1 + part * static_cast<double>(all - 1)));
  }
  return result;
}

}  // namespace

FoldDetector::FoldDetector(const PreparedPslg& prepared,
                           const SegmentIndex& index,
                           double tolerance,
                           const Point2* centre)
    : prepared_(prepared),
      index_(index),
      isolated_(isolated_points(prepared)),
      tolerance_(std::max(tolerance, prepared.resolution())),
      centre_given_(centre != nullptr),
      centre_(centre != nullptr ? *centre : prepared.centroid) {
  sort_by_kind();
  collect_samples();
  count_radii();
  keep_discriminating_samples();
}

// One index a kind: a search among edges that do not count would visit all within its reach.
void FoldDetector::sort_by_kind() {
  std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, std::int32_t> kinds;
  std::vector<std::vector<std::int32_t>> edges;
  for (std::size_t e = 0; e < prepared_.edges.size(); ++e) {
    const PreparedEdge& edge = prepared_.edges[e];
    const std::int32_t marker = prepared_.ignore_markers ? 0 : edge.marker;
    const std::tuple key{marker, std::min(edge.left, edge.right), std::max(edge.left, edge.right)};
    const auto [kind, fresh] = kinds.try_emplace(key, static_cast<std::int32_t>(edges.size()));
    if (fresh) edges.emplace_back();
    edges[at(kind->second)].push_back(static_cast<std::int32_t>(e));
    kind_of_.push_back(kind->second);
  }
  for (std::vector<std::int32_t>& of_kind : edges) {
    std::vector<IndexedSegment> segments;
    for (const std::int32_t e : of_kind) {
      segments.push_back({prepared_.points[at(prepared_.edges[at(e)].a)],
                          prepared_.points[at(prepared_.edges[at(e)].b)]});
    }
    kinds_.push_back({std::move(of_kind), SegmentIndex(segments)});
  }
}

void FoldDetector::collect_samples() {
  samples_.resize(prepared_.points.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    samples_[i] = {prepared_.points[i], static_cast<std::int32_t>(i), -1, true, 1e300};
  }
  for (const PreparedEdge& edge : prepared_.edges) {
    const double size = distance(prepared_.points[at(edge.a)], prepared_.points[at(edge.b)]);
    for (const std::int32_t v : {edge.a, edge.b}) {
      samples_[at(v)].isolated = false;
      samples_[at(v)].spacing = std::min(samples_[at(v)].spacing, size);
    }
  }
  samples_.reserve(samples_.size() + prepared_.edges.size());
  for (std::size_t e = 0; e < prepared_.edges.size(); ++e) {
    const PreparedEdge& edge = prepared_.edges[e];
    const Point2 a = prepared_.points[at(edge.a)];
    const Point2 middle = a + 0.5 * (prepared_.points[at(edge.b)] - a);
    samples_.push_back({middle, edge.a, static_cast<std::int32_t>(e), false, 0});
  }
}

// How many vertices the rarest radius has: a fold divides that, but for vertices off their place.
void FoldDetector::count_radii() {
  std::vector<double> radii;
  for (const Sample& s : samples_) {
    if (s.edge < 0) radii.push_back(distance(s.point, centre_));
  }
  std::sort(radii.begin(), radii.end());
  for (const double share : kRadiusGaps) {
    const double gap = std::max(share * prepared_.diameter, prepared_.resolution());
    if (gap > 3 * tolerance_ && !class_sizes_.empty()) break;
    std::int64_t fewest = 0;
    for (std::size_t begin = 0; begin < radii.size();) {
      std::size_t end = begin + 1;
      while (end < radii.size() && radii[end] - radii[end - 1] <= gap) ++end;
      const auto size = static_cast<std::int64_t>(end - begin);
      if (radii[begin] > gap && (fewest == 0 || size < fewest)) fewest = size;
      begin = end;
    }
    if (fewest > 0) class_sizes_.push_back(fewest);
  }
}

// Orders the samples by how few share their distance from the centre: those distinguish most folds.
// Of very many, keeps half from the front and half from all over.
void FoldDetector::keep_discriminating_samples() {
  struct Ranked {
    double radius;
    std::int32_t sample;
    std::int64_t rank;
  };
  std::vector<Ranked> ranked(samples_.size());
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    ranked[i] = {distance(samples_[i].point, centre_), static_cast<std::int32_t>(i), 0};
  }
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& r, const Ranked& s) {
    return r.radius < s.radius || (r.radius == s.radius && r.sample < s.sample);
  });
  const double gap = kRankGapRel * prepared_.diameter;
  for (std::size_t begin = 0; begin < ranked.size();) {
    std::size_t end = begin + 1;
    while (end < ranked.size() && ranked[end].radius - ranked[end - 1].radius <= gap) ++end;
    for (std::size_t i = begin; i < end; ++i) {
      ranked[i].rank = static_cast<std::int64_t>(end - begin);
    }
    begin = end;
  }
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& r, const Ranked& s) {
    return r.rank < s.rank || (r.rank == s.rank && r.sample < s.sample);
  });
  std::vector<Sample> kept;
  const std::size_t front = std::min(ranked.size(), kMaxSamples / 2);
  for (std::size_t i = 0; i < front; ++i) kept.push_back(samples_[at(ranked[i].sample)]);
  const std::size_t rest = ranked.size() - front;
  const std::size_t spread = std::min(rest, kMaxSamples / 2);
  for (std::size_t i = 0; i < spread; ++i) {
    kept.push_back(samples_[at(ranked[front + i * rest / spread].sample)]);
  }
  samples_ = std::move(kept);
}

// Whether an edge of the same kind has the faces on the sides where another has them that is turned
// to run `along`.
bool FoldDetector::alike(std::int32_t id, const PreparedEdge& edge, Point2 along) const {
  const PreparedEdge& other = prepared_.edges[at(id)];
  const Point2 w = prepared_.points[at(other.b)] - prepared_.points[at(other.a)];
  return dot(along, w) >= 0 ? other.left == edge.left && other.right == edge.right
                            : other.left == edge.right && other.right == edge.left;
}

// Distance of the image from the nearest entity of the sample's kind, up to `reach`; else infinity.
double FoldDetector::miss(
    const Sample& sample, Point2 image, double cosine, double sine, double reach) const {
  if (sample.isolated) return isolated_.nearest(image, reach).distance;
  if (sample.edge < 0) return index_.nearest(image, reach).distance;
  const PreparedEdge& edge = prepared_.edges[at(sample.edge)];
  const Point2 u = prepared_.points[at(edge.b)] - prepared_.points[at(edge.a)];
  const Point2 along{cosine * u.x - sine * u.y, sine * u.x + cosine * u.y};
  const Kind& kind = kinds_[at(kind_of_[at(sample.edge)])];
  const auto same = [&](std::int32_t id) { return alike(kind.edges[at(id)], edge, along); };
  return kind.index.nearest(image, reach, same).distance;
}

// Whether `miss` is within the reach, which is much faster to tell where that is large.
bool FoldDetector::fits(
    const Sample& sample, Point2 image, double cosine, double sine, double reach) const {
  const auto any = [](std::int32_t) { return true; };
  if (sample.isolated) return isolated_.any_within(image, reach, any);
  if (sample.edge < 0) return index_.any_within(image, reach, any);
  const PreparedEdge& edge = prepared_.edges[at(sample.edge)];
  const Point2 u = prepared_.points[at(edge.b)] - prepared_.points[at(edge.a)];
  const Point2 along{cosine * u.x - sine * u.y, sine * u.x + cosine * u.y};
  const Kind& kind = kinds_[at(kind_of_[at(sample.edge)])];
  const auto same = [&](std::int32_t id) { return alike(kind.edges[at(id)], edge, along); };
  return kind.index.any_within(image, reach, same);
}

// The first samples in the given order; one that misses moves to the front from then on: it will
// tell most other folds, too.
bool FoldDetector::fits_turn(double angle,
                             double reach,
                             std::size_t samples,
                             std::vector<std::int32_t>& order) const {
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  for (std::size_t i = 0; i < std::min(samples, order.size()); ++i) {
    const Sample& s = samples_[at(order[i])];
    ++looks_;
    if (fits(s, turn(s.point, centre_, cosine, sine), cosine, sine, reach)) continue;
    std::swap(order[i], order[i / 2]);
    return false;
  }
  return true;
}

// Few samples under all turns, then more.
bool FoldDetector::passes_first_look(std::int32_t fold,
                                     double reach,
                                     std::vector<std::int32_t>& order) const {
  for (const std::size_t samples : kFirstSamples) {
    for (const double share : kFirstTurns) {
      const double k = std::max(1.0, std::round(share * fold));
      if (!fits_turn(2 * std::numbers::pi * k / fold, reach, samples, order)) return false;
    }
  }
  return fits_turn(2 * std::numbers::pi / fold, reach, kMaxSamples, order);
}

// The largest miss under angles that no fold has, or one above `enough`.
double FoldDetector::arbitrary_angle_error(double enough) const {
  double worst = 0;
  for (int i = 1; i <= 4; ++i) {
    const double angle = 2 * std::numbers::pi * i * (std::numbers::phi - 1);
    const double cosine = std::cos(angle);
    const double sine = std::sin(angle);
    for (const Sample& s : samples_) {
      worst = std::max(worst, miss(s, turn(s.point, centre_, cosine, sine), cosine, sine, enough));
      if (worst > enough) return worst;
    }
  }
  return worst;
}

bool FoldDetector::divides_a_class(std::int32_t fold) const {
  return std::any_of(class_sizes_.begin(), class_sizes_.end(),
                     [fold](std::int64_t size) { return size % fold == 0; });
}

// Folds that pass a first look. Where arbitrary angles nearly fit, a fold must stand out from them,
// or be suggested by the numbers of vertices.
Result<std::vector<std::int32_t>> FoldDetector::candidates(double arbitrary,
                                                           double reach,
                                                           ExecutionContext& context) const {
  const auto points = static_cast<std::int64_t>(prepared_.points.size());
  const auto highest = static_cast<std::int32_t>(std::min<std::int64_t>(points, kMaxFold));
  const bool nearly_round = arbitrary <= kDominance * reach;
  const double slack = kCentroidTolerances * tolerance_;
  const double outstanding = std::max(arbitrary / kDominance, prepared_.resolution());
  std::vector<std::int32_t> order(samples_.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::int32_t> result;
  const auto look_at = [&](std::int32_t n, bool suggested) {
    double allowed = (n <= kMostNearFold ? reach : tolerance_) + slack;
    if (nearly_round && n > kAlwaysTried && !suggested) {
      allowed = std::min(allowed, 1.5 * outstanding);
    }
    if (passes_first_look(n, allowed, order)) result.push_back(n);
  };
  // What the vertices suggest, however long that takes; then all, while there is time.
  looks_ = 0;
  for (std::int32_t n = 2; n <= highest; ++n) {
    if (n <= kAlwaysTried || divides_a_class(n)) look_at(n, true);
  }
  looks_ = 0;
  for (std::int32_t n = kAlwaysTried + 1; n <= highest && looks_ < kMostLooks; ++n) {
    if ((n & 0xff) == 0) {
      SYMCELL_TRY(context.check());
    }
    if (!divides_a_class(n)) look_at(n, false);
  }
  std::sort(result.begin(), result.end());
  return result;
}

Result<std::vector<FoldFit>> FoldDetector::ladder(double reach, ExecutionContext& context) const {
  const double arbitrary = arbitrary_angle_error(2 * kDominance * reach);
  auto folds = candidates(arbitrary, reach, context);
  if (!folds) return error_of(folds);
  if (std::ssize(*folds) > kMostFolds) folds->erase(folds->begin(), folds->end() - kMostFolds);
  std::vector<FoldFit> fits;
  const auto count = std::max<std::int64_t>(std::ssize(*folds), 1);
  const Effort effort{reach + kCentroidTolerances * tolerance_,
                      std::clamp(kSearchesLadder / count, kFewestSearches, kMostSearches)};
  for (const std::int32_t n : *folds) {
    SYMCELL_TRY(context.check());
    const FoldFit found = fit(n, effort);
    if (found.error <= (n <= kMostNearFold ? reach : tolerance_)) fits.push_back(found);
  }
  judge(fits, arbitrary);
  return fits;
}

void FoldDetector::judge(std::vector<FoldFit>& fits, double arbitrary) const {
  const double floor = prepared_.resolution();
  for (FoldFit& f : fits) {
    f.kept = f.vertices_match || std::max(f.error, floor) <= arbitrary / kDominance;
  }
  std::vector<FoldFit> judged = fits;
  for (FoldFit& f : judged) {
    for (const FoldFit& other : fits) {
      if (!other.kept || f.fold % other.fold == 0 || other.fold % f.fold == 0) continue;
      if (std::max(other.error, floor) < f.error / kDominance) f.kept = false;
    }
  }
  fits = std::move(judged);
}

FoldFit FoldDetector::fit(std::int32_t fold) const {
  return fit(fold, {2 * prepared_.diameter, kSearchesGiven});
}

FoldFit FoldDetector::fit(std::int32_t fold, const Effort& effort) const {
  FoldFit result;
  result.fold = fold;
  result.centre = centre_;
  measure(result, effort);
  if (!centre_given_ && fold > 1 && result.error > 8 * prepared_.resolution()) {
    FoldFit refined = result;
    const double angle = 2 * std::numbers::pi * (fold / 2) / fold;
    const double reach = 8 * std::max(tolerance_, std::min(result.error, effort.reach));
    refined.centre = refine_centre(angle, centre_, std::min(reach, 0.1 * prepared_.diameter));
    measure(refined, effort);
    if (refined.error < result.error) result = refined;
  }
  result.vertices_match = vertices_match(result);
  return result;
}

// Gauss-Newton on the distances between the samples turned by `angle` and the segments' lines.
// About half a turn the error depends most on the centre.
Point2 FoldDetector::refine_centre(double angle, Point2 centre, double reach) const {
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  for (int round = 0; round < 5; ++round) {
    double xx = 0, xy = 0, yy = 0, bx = 0, by = 0;
    for (const Sample& s : samples_) {
      if (s.isolated) continue;
      const Point2 image = turn(s.point, centre, cosine, sine);
      const SegmentIndex::Hit hit = index_.nearest(image, reach);
      if (hit.segment < 0) continue;
      const PreparedEdge& edge = prepared_.edges[at(hit.segment)];
      const Point2 a = prepared_.points[at(edge.a)];
      const Point2 u = prepared_.points[at(edge.b)] - a;
      const double size = length(u);
      const Point2 normal{-u.y / size, u.x / size};
      // d(image)/d(centre) = I - R.
      const Point2 row{normal.x * (1 - cosine) - normal.y * sine,
                       normal.x * sine + normal.y * (1 - cosine)};
      const double residual = dot(normal, a - image);
      xx += row.x * row.x;
      xy += row.x * row.y;
      yy += row.y * row.y;
      bx += row.x * residual;
      by += row.y * residual;
    }
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 1e-9 * (xx + yy) * (xx + yy))) return centre;
    const Point2 step{(bx * yy - by * xy) / determinant, (by * xx - bx * xy) / determinant};
    centre = centre + step;
    if (length(step) <= prepared_.resolution()) break;
  }
  return centre;
}

void FoldDetector::measure(FoldFit& fit, const Effort& effort) const {
  fit.error = 0;
  fit.worst_point = -1;
  const auto samples = static_cast<std::int64_t>(samples_.size());
  const std::int64_t turns = std::max<std::int64_t>(2, effort.searches / (samples + 1));
  const std::int64_t step = std::max<std::int64_t>(1, turns * samples / effort.searches);
  for (const std::int32_t k : multiples(fit.fold, turns)) {
    const double angle = 2 * std::numbers::pi * k / fit.fold;
    const double cosine = std::cos(angle);
    const double sine = std::sin(angle);
    for (std::int64_t i = k % step; i < samples; i += step) {
      const Sample& s = samples_[static_cast<std::size_t>(i)];
      const Point2 image = turn(s.point, fit.centre, cosine, sine);
      // Most searches end within the tolerance, which is much faster than an open one.
      double error = miss(s, image, cosine, sine, tolerance_);
      if (error > tolerance_) error = miss(s, image, cosine, sine, effort.reach);
      if (error <= fit.error) continue;
      fit.error = error;
      fit.worst_point = s.vertex;
      if (error > effort.reach) return;
    }
  }
}

// Whether vertices fall on vertices when the model is turned once.
bool FoldDetector::vertices_match(const FoldFit& fit) const {
  const double angle = 2 * std::numbers::pi / fit.fold;
  for (const Sample& s : samples_) {
    if (s.edge >= 0 || s.isolated) continue;
    const Point2 image = turn(s.point, fit.centre, std::cos(angle), std::sin(angle));
    const double near = std::min(tolerance_, 0.1 * s.spacing);
    const SegmentIndex::Hit hit = index_.nearest(image, near);
    if (hit.segment < 0) return false;
    const PreparedEdge& edge = prepared_.edges[at(hit.segment)];
    const auto meets = [&](std::int32_t v) {
      return distance(prepared_.points[at(v)], image) <= near;
    };
    if (!meets(edge.a) && !meets(edge.b)) return false;
  }
  return true;
}

}  // namespace symcell::plane
