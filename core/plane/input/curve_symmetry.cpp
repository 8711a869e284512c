#include "core/plane/input/curve_symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/base/index.hpp"
#include "core/cell/inspection.hpp"
#include "core/geometry/arc.hpp"
#include "core/geometry/point_grid.hpp"

namespace symcell::plane {
namespace {

// By length: it does not depend on where curves are cut.
Point2 centroid_of(const Pslg& pslg, const ArcChains& arcs) {
  double total = 0;
  Point2 moment;
  const auto add = [&](Point2 place, double size) {
    total += size;
    moment = moment + size * place;
  };
  const Point2 reference = pslg.vertices.front();  // keeps the digits far from the origin
  for (std::size_t s = 0; s < pslg.segments.size(); ++s) {
    if (pslg.bulge(s) != 0) continue;
    const Point2 a = pslg.vertices[at(pslg.segments[s].a)] - reference;
    const Point2 b = pslg.vertices[at(pslg.segments[s].b)] - reference;
    add(0.5 * (a + b), distance(a, b));
  }
  for (const ArcChain& chain : arcs.chains) {
    const double half = std::abs(chain.angle) / 2;
    Point2 off;
    if (!chain.whole()) {
      const Point2 spoke = pslg.vertices[at(chain.a)] - chain.centre;
      off = std::sin(half) / half * turned(spoke, chain.angle / 2);
    }
    add(chain.centre - reference + off, 2 * half * chain.radius);
  }
  return total > 0 ? reference + (1 / total) * moment : reference;
}

struct Feature {
  Point2 place;  // relative to the centre
  // The radius of a circle; 0: a corner; negative: by its middle an arc, the distance of its ends. Its radius
  // would be known too badly where the arc is nearly straight and its ends are rounded.
  double size = 0;
};

class Finder {
 public:
  Finder(const Pslg& pslg, const ArcChains& arcs, Point2 centre, double tolerance)
      : pslg_(pslg), arcs_(arcs), centre_(centre), tolerance_(tolerance) {}

  std::int32_t run() {
    collect();
    if (features_.empty()) return arcs_.chains.empty() ? 1 : 0;
    const std::int64_t common = common_count();
    std::vector<std::int32_t> divisors;
    for (std::int64_t n = 1; n * n <= common; ++n) {
      if (common % n != 0) continue;
      for (const std::int64_t d : {n, common / n}) {
        if (d <= kMaxFold) divisors.push_back(static_cast<std::int32_t>(d));
      }
    }
    std::sort(divisors.rbegin(), divisors.rend());
    for (const std::int32_t n : divisors) {
      if (n == 1 || permutes(n)) return n;
    }
    return 1;
  }

 private:
  void collect() {
    const std::vector<char> corner = corners();
    for (std::size_t v = 0; v < corner.size(); ++v) {
      if (corner[v] != 0) features_.push_back({pslg_.vertices[v] - centre_, 0});
    }
    for (const ArcChain& chain : arcs_.chains) {
      const Point2 middle = chain.centre - centre_;
      if (!chain.whole()) {
        const Point2 a = pslg_.vertices[at(chain.a)], b = pslg_.vertices[at(chain.b)];
        const Point2 spoke = a - chain.centre;
        features_.push_back({middle + turned(spoke, chain.angle / 2), -distance(a, b)});
      } else if (length(middle) > tolerance_) {
        features_.push_back({middle, chain.radius});
      }
    }
  }

  // Vertices where the curves end, branch or turn; loose ones, too.
  [[nodiscard]] std::vector<char> corners() const {
    std::vector<char> result(pslg_.vertices.size(), 1);
    std::vector<std::int32_t> degree(result.size(), 0), sum(result.size(), 0);
    for (std::size_t s = 0; s < pslg_.segments.size(); ++s) {
      const PslgSegment& segment = pslg_.segments[s];
      for (const auto& [v, other] : {std::pair(segment.a, segment.b), {segment.b, segment.a}}) {
        degree[at(v)] += pslg_.bulge(s) == 0 ? 1 : 3;  // an arc's end is no mere point of a line
        sum[at(v)] ^= other;
        first_.resize(result.size(), -1);
        if (first_[at(v)] < 0) first_[at(v)] = other;
      }
    }
    for (std::size_t v = 0; v < result.size(); ++v) {
      if (arcs_.is_joint[v] != 0) result[v] = 0;
      if (degree[v] != 2) continue;
      const Point2 p = pslg_.vertices[v], q = pslg_.vertices[at(first_[v])],
                   r = pslg_.vertices[at(sum[v] ^ first_[v])];
      const double off = std::abs(cross(q - p, r - q)) / std::max(distance(q, r), tolerance_);
      if (off <= tolerance_ && dot(q - p, r - p) < 0) result[v] = 0;
    }
    return result;
  }

  // What every fold divides: the greatest common divisor of how many lie as far from the centre.
  [[nodiscard]] std::int64_t common_count() const {
    std::vector<double> distances;
    for (const Feature& f : features_) distances.push_back(length(f.place));
    std::sort(distances.begin(), distances.end());
    std::int64_t common = 0;
    for (std::size_t begin = 0; begin < distances.size();) {
      std::size_t end = begin + 1;
      while (end < distances.size() && distances[end] - distances[end - 1] <= 2 * tolerance_) ++end;
      if (distances[begin] > 2 * tolerance_) {
        common = std::gcd(common, static_cast<std::int64_t>(end - begin));
      }
      begin = end;
    }
    return std::max<std::int64_t>(common, 1);
  }

  [[nodiscard]] bool permutes(std::int32_t fold) {
    if (!grid_) {
      grid_.emplace(2 * tolerance_, features_.size());
      for (std::size_t i = 0; i < features_.size(); ++i) {
        grid_->insert(features_[i].place, static_cast<std::int32_t>(i));
      }
    }
    const double angle = 2 * std::numbers::pi / fold;
    return std::all_of(features_.begin(), features_.end(), [&](const Feature& f) {
      const std::int32_t other = grid_->nearest(turned(f.place, angle));
      return other >= 0 && std::abs(features_[at(other)].size - f.size) <= 2 * tolerance_;
    });
  }

  const Pslg& pslg_;
  const ArcChains& arcs_;
  Point2 centre_;
  double tolerance_;
  mutable std::vector<std::int32_t> first_;  // per vertex: a neighbour
  std::vector<Feature> features_;
  std::optional<PointGrid> grid_;
};

}  // namespace

CurveSymmetry find_curve_symmetry(const Pslg& pslg,
                                  const ArcChains& chains,
                                  const MeshOptions& options,
                                  double tolerance) {
  CurveSymmetry result;
  result.centre = options.center ? *options.center : centroid_of(pslg, chains);
  if (options.fold) {
    result.fold = *options.fold;
    return result;
  }
  // A fold that only just does not fit is told by its vertices, too.
  result.fold = Finder(pslg, chains, result.centre, tolerance).run();
  const std::int32_t nearly =
      Finder(pslg, chains, result.centre, kNearTolerances * tolerance).run();
  if (result.fold > 0 && nearly % result.fold == 0 && nearly > 0) result.fold = nearly;
  return result;
}

}  // namespace symcell::plane
