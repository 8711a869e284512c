#include "core/plane/symmetry/chain_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/geometry/segment_index.hpp"

namespace symcell::plane {
namespace {

// Weight of a squared distance, in asymmetries, against one more edge. The best edge of an arc that
// its copies cut in edges of length 1, out of phase, is then 1.07 long: as long as it was.
constexpr double kDistanceWeight = 0.25;
// Vertices of two copies are one if they are nearer than so many asymmetries, and than this share of
// the shorter edge there: no two of a copy are then taken for one.
constexpr double kLinkAsymmetries = 2;
constexpr double kLinkShare = 0.3;
// Vertices are chosen from so many copies: more would only make the choice finer than an eighth of
// an edge. And an edge skips at most so many of them. Both bound the time.
constexpr std::size_t kMostSources = 8;
constexpr std::size_t kMostSkipped = 150;
// How far ahead the next place is looked for: a line may be longer than its chord, in turns finer
// than the reach.
constexpr double kWindowLengths = 2;
constexpr double kWindowReaches = 4;

struct Candidate {
  double place = 0;  // along the first copy
  std::size_t copy = 0;
  Point2 point;
  double spacing = 0;  // length of the shorter edge at it
  bool kept = false;   // all copies have it
};

class Fit {
 public:
  Fit(std::span<const std::vector<Point2>> copies,
      const ChainFitRequest& request,
      ExecutionContext& context)
      : copies_(copies), request_(request), context_(context) {}

  Result<FittedChain> run() {
    SYMCELL_TRY(compare());
    join();
    SYMCELL_TRY(choose());
    return std::move(result_);
  }

 private:
  // Collects the vertices by their places along the copy that has the most.
  Result<void> compare() {
    const auto more = [](const auto& a, const auto& b) { return a.size() < b.size(); };
    const std::vector<Point2>& line = *std::max_element(copies_.begin(), copies_.end(), more);
    std::vector<IndexedSegment> segments;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) segments.push_back({line[i], line[i + 1]});
    const SegmentIndex index(segments);
    const double reach = 2 * request_.tolerance;
    double asymmetry = request_.resolution;
    for (std::size_t c = 0; c < copies_.size(); ++c) {
      SYMCELL_TRY(context_.check());
      const std::vector<Point2>& copy = copies_[c];
      const std::vector<double> places = places_along(line, copy, reach);
      const std::vector<double> back = places_along(copy, line, reach);
      if (places.empty() || back.empty()) {
        return fail(ErrorCode::kNotSymmetric, "outlines of the sectors run apart");
      }
      for (std::size_t i = 1; i + 1 < copy.size(); ++i) {
        const double spacing =
            std::min(distance(copy[i], copy[i - 1]), distance(copy[i], copy[i + 1]));
        candidates_.push_back({places[i], c, copy[i], spacing, false});
        asymmetry = std::max(asymmetry, index.nearest(copy[i], 2 * reach).distance);
      }
      asymmetry = std::max(asymmetry, farthest_vertex(line, copy));
    }
    result_.asymmetry = asymmetry;
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.place < b.place; });
    return {};
  }

  [[nodiscard]] double farthest_vertex(std::span<const Point2> line,
                                       std::span<const Point2> copy) const {
    std::vector<IndexedSegment> segments;
    for (std::size_t i = 0; i + 1 < copy.size(); ++i) segments.push_back({copy[i], copy[i + 1]});
    const SegmentIndex index(segments);
    double worst = 0;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      worst = std::max(worst, index.nearest(line[i], 4 * request_.tolerance).distance);
    }
    return worst;
  }

  // Makes one of the vertices, of different copies, that stand together.
  void join() {
    const double link = std::min(kLinkAsymmetries * result_.asymmetry,
                                 std::max(request_.tolerance, request_.resolution));
    result_.shifts.assign(copies_.size(), {});
    std::vector<Candidate> joined;
    std::vector<std::size_t> seen(copies_.size(), 0);  // the group that a copy was last in, from 1
    std::vector<char> taken(candidates_.size(), 0);
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (taken[i] != 0) continue;
      const Candidate& first = candidates_[i];
      Point2 sum;
      double spacing = first.spacing;
      std::vector<std::size_t> members;
      for (std::size_t j = i; j < candidates_.size(); ++j) {
        const Candidate& c = candidates_[j];
        // Places differ by hardly more than the distance, where copies run along each other.
        if (c.place - first.place > kWindowLengths * link + result_.asymmetry) break;
        const double near = std::max(std::min(link, kLinkShare * std::min(spacing, c.spacing)),
                                     request_.resolution);
        if (taken[j] != 0 || seen[c.copy] == i + 1 || distance(c.point, first.point) > near) {
          continue;
        }
        seen[c.copy] = i + 1;
        taken[j] = 1;
        spacing = std::min(spacing, c.spacing);
        sum = sum + c.point;
        members.push_back(j);
      }
      Candidate one = first;
      one.point = (1 / static_cast<double>(members.size())) * sum;
      one.kept = members.size() == copies_.size();
      if (one.kept) {
        ++result_.shared;
        for (const std::size_t j : members) {
          Point2& shift = result_.shifts[candidates_[j].copy];
          shift = shift + (candidates_[j].point - one.point);
        }
      }
      joined.push_back(one);
    }
    candidates_ = std::move(joined);
  }

  Result<void> choose() {
    std::vector<Candidate> line{{0, 0, request_.first, 0, true}};
    const std::size_t step = (copies_.size() + kMostSources - 1) / kMostSources;
    for (const Candidate& c : candidates_) {
      if (c.kept || c.copy % step == 0) line.push_back(c);
    }
    line.push_back({0, 0, request_.last, 0, true});
    for (std::size_t begin = 0; begin + 1 < line.size();) {
      SYMCELL_TRY(context_.check());
      std::size_t end = begin + 1;
      while (!line[end].kept) ++end;
      choose_between(std::span(line).subspan(begin, end - begin + 1));
      if (end + 1 < line.size()) result_.points.push_back(line[end].point);
      begin = end;
    }
    return {};
  }

  // Adds what is best between the first and the last, which both stay.
  void choose_between(std::span<const Candidate> line) {
    const double e = result_.asymmetry;
    const double most = std::min(request_.most_asymmetries * e, std::max(request_.tolerance, e));
    std::vector<double> cost(line.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> from(line.size(), 0);
    cost[0] = 0;
    for (std::size_t j = 1; j < line.size(); ++j) {
      const std::size_t first = j > kMostSkipped ? j - kMostSkipped : 0;
      for (std::size_t i = j; i-- > first;) {
        double off = 0;
        for (std::size_t m = i + 1; m < j; ++m) {
          off = std::max(off,
                         squared_distance_to_segment(line[m].point, line[i].point, line[j].point));
        }
        if (off > 16 * most * most) break;  // farther back it hardly gets better
        if (off > most * most) continue;
        const double sum = cost[i] + 1 + kDistanceWeight * off / (e * e);
        if (sum >= cost[j]) continue;
        cost[j] = sum;
        from[j] = i;
      }
    }
    std::vector<Point2> chosen;
    for (std::size_t j = from[line.size() - 1]; j > 0; j = from[j]) chosen.push_back(line[j].point);
    result_.points.insert(result_.points.end(), chosen.rbegin(), chosen.rend());
  }

  std::span<const std::vector<Point2>> copies_;
  const ChainFitRequest& request_;
  ExecutionContext& context_;
  std::vector<Candidate> candidates_;
  FittedChain result_;
};

}  // namespace

Result<FittedChain> fit_chain(std::span<const std::vector<Point2>> copies,
                              const ChainFitRequest& request,
                              ExecutionContext& context) {
  return Fit(copies, request, context).run();
}

std::vector<double> places_along(std::span<const Point2> line,
                                 std::span<const Point2> points,
                                 double reach) {
  std::vector<double> start(line.size(), 0);  // length before each of the line's points
  for (std::size_t i = 1; i < line.size(); ++i) {
    start[i] = start[i - 1] + distance(line[i - 1], line[i]);
  }
  std::vector<double> result;
  result.reserve(points.size());
  std::size_t segment = 0;
  double here = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double step = p > 0 ? distance(points[p - 1], points[p]) : 0;
    const double window = here + kWindowLengths * step + kWindowReaches * reach;
    double best = std::numeric_limits<double>::infinity();
    double place = here;
    std::size_t at = segment;
    for (std::size_t s = segment; s + 1 < line.size() && start[s] <= window; ++s) {
      const double size = start[s + 1] - start[s];
      const Point2 u = line[s + 1] - line[s];
      double along = size > 0 ? dot(points[p] - line[s], u) / size : 0;
      along = std::clamp(along, 0.0, size);
      if (s == segment) along = std::max(along, std::min(here - start[s], size));
      const Point2 foot = line[s] + (size > 0 ? along / size : 0) * u;
      const double squared = squared_distance(points[p], foot);
      if (squared >= best) continue;
      best = squared;
      place = start[s] + along;
      at = s;
    }
    if (!(best <= reach * reach)) return {};
    here = place;
    segment = at;
    result.push_back(place);
  }
  return result;
}

}  // namespace symcell::plane
