#include "core/plane/symmetry/fold_detection.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

#include "core/cell/inspection.hpp"

namespace symcell::plane {
namespace {

// Points that folds are tested by, half of them the rarest; and look-ups of the nearest segment a
// fold, of which large folds get a spread of their turns. Both bound the time of a detection.
constexpr std::size_t kMaxSamples = 2000;
constexpr std::int64_t kQueriesPerFold = 50'000;
// How far off the centroid may be as a centre, at a first look.
constexpr double kCentroidTolerances = 4;
constexpr std::ptrdiff_t kMostNear = 24;  // folds beyond the tolerance that are measured

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

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
std::vector<std::int32_t> multiples(std::int32_t fold, std::size_t samples) {
  const std::int64_t all = fold - 1;
  const std::int64_t affordable =
      std::max<std::int64_t>(3, kQueriesPerFold / static_cast<std::int64_t>(samples + 1));
  std::vector<std::int32_t> result;
  if (all <= affordable) {
    result.resize(static_cast<std::size_t>(all));
    std::iota(result.begin(), result.end(), 1);
    return result;
  }
  for (std::int64_t i = 0; i < affordable; ++i) {
    result.push_back(static_cast<std::int32_t>(1 + i * (all - 1) / (affordable - 1)));
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
  collect_samples();
  keep_discriminating_samples();
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
  const double gap = 3 * tolerance_;
  for (std::size_t begin = 0; begin < ranked.size();) {
    std::size_t end = begin + 1;
    while (end < ranked.size() && ranked[end].radius - ranked[end - 1].radius <= gap) ++end;
    std::int64_t vertices = 0;
    for (std::size_t i = begin; i < end; ++i) {
      ranked[i].rank = static_cast<std::int64_t>(end - begin);
      if (samples_[at(ranked[i].sample)].edge < 0) ++vertices;
    }
    if (ranked[begin].radius > gap && vertices > 0 &&
        (smallest_class_ == 0 || vertices < smallest_class_)) {
      smallest_class_ = vertices;
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

// Distance of the image from the nearest entity of the sample's kind, up to `reach`; else infinity.
double FoldDetector::miss(
    const Sample& sample, Point2 image, double cosine, double sine, double reach) const {
  if (sample.isolated) return isolated_.nearest(image, reach).distance;
  if (sample.edge < 0) return index_.nearest(image, reach).distance;
  const PreparedEdge& edge = prepared_.edges[at(sample.edge)];
  const Point2 u = prepared_.points[at(edge.b)] - prepared_.points[at(edge.a)];
  const Point2 along{cosine * u.x - sine * u.y, sine * u.x + cosine * u.y};
  const auto alike = [&](std::int32_t id) {
    const PreparedEdge& other = prepared_.edges[at(id)];
    if (other.marker != edge.marker && !prepared_.ignore_markers) return false;
    const Point2 w = prepared_.points[at(other.b)] - prepared_.points[at(other.a)];
    return dot(along, w) >= 0 ? other.left == edge.left && other.right == edge.right
                              : other.left == edge.right && other.right == edge.left;
  };
  return index_.nearest(image, reach, alike).distance;
}

bool FoldDetector::passes_quickly(std::int32_t fold, double reach) const {
  const double angle = 2 * std::numbers::pi / fold;
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  return std::all_of(samples_.begin(), samples_.end(), [&](const Sample& s) {
    return miss(s, turn(s.point, centre_, cosine, sine), cosine, sine, reach) <= reach;
  });
}

double FoldDetector::arbitrary_angle_error() const {
  const double reach = 16 * tolerance_;
  double worst = 0;
  for (int i = 1; i <= 4; ++i) {
    const double angle = 2 * std::numbers::pi * i * (std::numbers::phi - 1);
    const double cosine = std::cos(angle);
    const double sine = std::sin(angle);
    for (const Sample& s : samples_) {
      worst = std::max(worst, miss(s, turn(s.point, centre_, cosine, sine), cosine, sine, reach));
      if (worst > reach) return worst;
    }
  }
  return worst;
}

// Where nearly every angle fits, only folds that the vertices suggest are looked at.
std::vector<std::int32_t> FoldDetector::candidates(bool revolution) const {
  const auto points = static_cast<std::int64_t>(prepared_.points.size());
  const auto highest = static_cast<std::int32_t>(std::min<std::int64_t>(points, kMaxFold));
  std::vector<std::int32_t> result;
  for (std::int32_t n = 2; n <= highest; ++n) {
    if (!revolution || n <= 12 || (smallest_class_ > 0 && smallest_class_ % n == 0)) {
      result.push_back(n);
    }
  }
  return result;
}

Result<std::vector<FoldFit>> FoldDetector::ladder(ExecutionContext& context) const {
  const double arbitrary = arbitrary_angle_error();
  std::vector<FoldFit> fits;
  for (const std::int32_t n : candidates(arbitrary <= 4 * tolerance_)) {
    SYMCELL_TRY(context.check());
    // The centroid may be off by more than the tolerance where the shape is only nearly symmetric.
    if (passes_quickly(n, kCentroidTolerances * tolerance_)) fits.push_back(fit(n));
  }
  judge(fits, arbitrary);
  return fits;
}

Result<std::vector<FoldFit>> FoldDetector::near(const std::vector<FoldFit>& known,
                                                double reach,
                                                ExecutionContext& context) const {
  const auto points = static_cast<std::int64_t>(prepared_.points.size());
  const auto highest = static_cast<std::int32_t>(std::min<std::int64_t>(points, kMostNearFold));
  std::vector<std::int32_t> folds;
  for (std::int32_t n = 2; n <= highest; ++n) {
    SYMCELL_TRY(context.check());
    const bool fits = std::any_of(known.begin(), known.end(), [&](const FoldFit& f) {
      return f.fold == n && f.error <= tolerance_;
    });
    if (!fits && passes_quickly(n, reach + kCentroidTolerances * tolerance_)) folds.push_back(n);
  }
  std::vector<FoldFit> result;
  if (folds.empty()) return result;
  // With that tolerance: the centre is sought within its reach.
  const FoldDetector wide(prepared_, index_, reach, centre_given_ ? &centre_ : nullptr);
  const auto wanted = wide.candidates(wide.arbitrary_angle_error() <= kCentroidTolerances * reach);
  std::erase_if(
      folds, [&](std::int32_t n) { return !std::binary_search(wanted.begin(), wanted.end(), n); });
  if (std::ssize(folds) > kMostNear) folds.erase(folds.begin(), folds.end() - kMostNear);
  for (const std::int32_t n : folds) {
    SYMCELL_TRY(context.check());
    const FoldFit fit = wide.fit(n);
    if (fit.error <= reach) result.push_back(fit);
  }
  return result;
}

void FoldDetector::judge(std::vector<FoldFit>& fits, double arbitrary) const {
  const double floor = prepared_.resolution();
  for (FoldFit& f : fits) {
    f.kept =
        f.error <= tolerance_ && (f.vertices_match || std::max(f.error, floor) <= arbitrary / 4);
  }
  std::vector<FoldFit> judged = fits;
  for (FoldFit& f : judged) {
    for (const FoldFit& other : fits) {
      if (!other.kept || f.fold % other.fold == 0 || other.fold % f.fold == 0) continue;
      if (std::max(other.error, floor) < f.error / 4) f.kept = false;
    }
  }
  fits = std::move(judged);
}

FoldFit FoldDetector::fit(std::int32_t fold) const {
  FoldFit result;
  result.fold = fold;
  result.centre = centre_;
  measure(result);
  if (centre_given_ || fold == 1 || result.error <= 8 * prepared_.resolution()) return result;
  FoldFit refined = result;
  refined.centre = refine_centre(fold, centre_);
  measure(refined);
  return refined.error < result.error ? refined : result;
}

// Gauss-Newton on the distances between the samples turned by about half a turn and the segments'
// lines: there the error depends most on the centre.
Point2 FoldDetector::refine_centre(std::int32_t fold, Point2 centre) const {
  const double angle = 2 * std::numbers::pi * (fold / 2) / fold;
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  const double reach = 8 * tolerance_;
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

void FoldDetector::measure(FoldFit& fit) const {
  fit.error = 0;
  fit.worst_point = -1;
  const double reach = 2 * prepared_.diameter;
  for (const std::int32_t k : multiples(fit.fold, samples_.size())) {
    const double angle = 2 * std::numbers::pi * k / fit.fold;
    const double cosine = std::cos(angle);
    const double sine = std::sin(angle);
    for (const Sample& s : samples_) {
      const Point2 image = turn(s.point, fit.centre, cosine, sine);
      // Most searches end within the tolerance, which is much faster than an open one.
      double error = miss(s, image, cosine, sine, tolerance_);
      if (error > tolerance_) error = miss(s, image, cosine, sine, reach);
      if (error <= fit.error) continue;
      fit.error = error;
      fit.worst_point = s.vertex;
    }
  }
  fit.vertices_match = true;
  const double angle = 2 * std::numbers::pi / fit.fold;
  for (const Sample& s : samples_) {
    if (s.edge >= 0 || s.isolated) continue;
    const Point2 image = turn(s.point, fit.centre, std::cos(angle), std::sin(angle));
    const double near = std::min(tolerance_, 0.1 * s.spacing);
    const SegmentIndex::Hit hit = index_.nearest(image, near);
    const auto meets = [&](std::int32_t v) {
      return distance(prepared_.points[at(v)], image) <= near;
    };
    if (hit.segment >= 0) {
      const PreparedEdge& edge = prepared_.edges[at(hit.segment)];
      if (meets(edge.a) || meets(edge.b)) continue;
    }
    fit.vertices_match = false;
    return;
  }
}

}  // namespace symcell::plane
