#include "core/solid/symmetry/shape_symmetry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "core/base/random.hpp"
#include "core/geometry/spatial_order.hpp"

namespace symcell::solid {
namespace {

// Points spread at random over the surface: all that are drawn, those (half of them vertices) that
// decide quickly whether a turn fits, and those that an axis is refined by. More see smaller
// features and take longer.
constexpr std::size_t kSpreadSamples = 4000;
constexpr std::size_t kFitSamples = 240;
constexpr std::size_t kRefineSamples = 2500;
// Distances of one error: enough that no feature that counts escapes, few enough for a second.
constexpr std::size_t kMostDistances = 150'000;
constexpr std::size_t kLeastSamples = 1000;  // of a large fold
constexpr int kMostIterations = 16;          // of the axis; a step that is small ends them earlier
// The first iterations look at fewer points, until a step is below this share of the diameter or
// they are so many. The last step is below the other.
constexpr std::size_t kRoughSamples = 400;
constexpr int kMostRough = 8;
constexpr double kRoughStep = 1e-5;
constexpr double kLeastStep = 1e-11;
// Points farther than this from the surface, of the diameter, do not pull at the axis.
constexpr double kPullReach = 0.1;
constexpr std::size_t kCheckEvery = 4096;  // samples: a cheap search each

// Gaussian elimination with pivoting; false if singular.
bool solve(std::array<std::array<double, 5>, 4>& m, std::array<double, 4>& x) {
  for (std::size_t c = 0; c < 4; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < 4; ++r) {
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    }
    if (!(std::abs(m[pivot][c]) > 0)) return false;
    std::swap(m[c], m[pivot]);
    for (std::size_t r = 0; r < 4; ++r) {
      if (r == c) continue;
      const double f = m[r][c] / m[c][c];
      for (std::size_t k = c; k < 5; ++k) m[r][k] -= f * m[c][k];
    }
  }
  for (std::size_t c = 0; c < 4; ++c) x[c] = m[c][4] / m[c][c];
  return true;
}

Point3 rotate_about(Point3 d, double cosine, double sine, Point3 q) {
  return cosine * q + sine * cross(d, q) + ((1 - cosine) * dot(d, q)) * d;
}

}  // namespace

Point3 turned(const SymmetryAxis& axis, double angle, Point3 p) {
  return axis.origin +
         rotate_about(axis.direction, std::cos(angle), std::sin(angle), p - axis.origin);
}

ShapeSymmetry::ShapeSymmetry(const IndexedSurface& surface, double diameter)
    : surface_(surface), diameter_(diameter), tree_(surface.points, surface.triangles) {
  choose_samples();
}

void ShapeSymmetry::choose_samples() {
  Random random(1);
  vertices_ = surface_.points;
  for (std::size_t i = vertices_.size(); i > 1; --i) {
    std::swap(vertices_[i - 1], vertices_[random.next() % i]);
  }
  std::vector<double> sums;
  double sum = 0;
  for (const Triangle& t : surface_.triangles) {
    sum += length(area_normal(surface_, t));
    sums.push_back(sum);
  }
  for (std::size_t i = 0; i < kSpreadSamples; ++i) {
    const double at = random.uniform() * sum;
    const auto found = std::upper_bound(sums.begin(), sums.end(), at) - sums.begin();
    const std::size_t t = std::min(static_cast<std::size_t>(found), sums.size() - 1);
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Triangle& c = surface_.triangles[t];
    const Point3 a = surface_.points[c[0]];
    spread_.push_back(a + u * (surface_.points[c[1]] - a) + v * (surface_.points[c[2]] - a));
  }
  // Half of the quick samples are vertices: they are where the shape has its extremes.
  for (std::size_t i = 0; i < kFitSamples; ++i) discriminating_.push_back(i);
}

// Each near the one before, so that a search can begin where the last one ended.
std::span<const Point3> ShapeSymmetry::samples_for(std::int32_t fold) const {
  if (samples_fold_ == fold) return samples_;
  const std::size_t samples =
      std::max(kLeastSamples, kMostDistances / static_cast<std::size_t>(fold));
  const auto first = [](const std::vector<Point3>& points, std::size_t count) {
    return std::span<const Point3>(points).first(std::min(points.size(), count));
  };
  const auto vertices = first(vertices_, samples), spread = first(spread_, samples / 4);
  samples_.assign(vertices.begin(), vertices.end());
  samples_.insert(samples_.end(), spread.begin(), spread.end());
  sort_along_hilbert_curve(samples_);
  samples_fold_ = fold;
  return samples_;
}

Result<ShapeError> ShapeSymmetry::turn_error(const SymmetryAxis& axis,
                                             std::int32_t steps,
                                             std::int32_t fold,
                                             double enough,
                                             ExecutionContext& context) const {
  const std::span<const Point3> samples = samples_for(fold);
  ShapeError worst;
  worst.steps = steps;
  const double angle = 2 * std::numbers::pi * steps / fold;
  const double c = std::cos(angle), s = std::sin(angle);
  std::int32_t last = -1;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % kCheckEvery == 0) {
      SYMCELL_TRY(context.check());
    }
    const Point3 q = axis.origin + rotate_about(axis.direction, c, s, samples[i] - axis.origin);
    if (worst.distance > 0 && tree_.within(q, worst.distance, last)) continue;
    const double distance = std::sqrt(tree_.nearest(q, diameter_, last).squared);
    if (distance <= worst.distance) continue;
    worst.distance = std::min(distance, diameter_);
    worst.worst = samples[i];
    if (worst.distance > enough) break;
  }
  return worst;
}

Result<ShapeError> ShapeSymmetry::error(const SymmetryAxis& axis,
                                        std::int32_t fold,
                                        double enough,
                                        ExecutionContext& context) const {
  ShapeError worst;
  for (std::int32_t k = 1; k < fold && worst.distance <= enough; ++k) {
    auto turn = turn_error(axis, k, fold, enough, context);
    if (!turn) return turn;
    if (turn->distance > worst.distance || worst.steps == 0) worst = *turn;
  }
  return worst;
}

bool ShapeSymmetry::fits(const SymmetryAxis& axis, double angle, double reach) const {
  const double c = std::cos(angle), s = std::sin(angle);
  for (std::size_t k = 0; k < discriminating_.size(); ++k) {
    const std::size_t i = discriminating_[k];
    const Point3 p = i % 2 == 0 ? vertices_[i / 2 % vertices_.size()] : spread_[i / 2];
    if (tree_.within(axis.origin + rotate_about(axis.direction, c, s, p - axis.origin), reach)) {
      continue;
    }
    std::rotate(discriminating_.begin(), discriminating_.begin() + static_cast<std::ptrdiff_t>(k),
                discriminating_.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    return false;
  }
  return true;
}

double ShapeSymmetry::mean_error(
    const SymmetryAxis& axis, double angle, double cap, std::size_t count, double enough) const {
  double sum = 0;
  count = std::min(count, spread_.size());
  const double most = enough * enough * static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (sum > most) return kInfinity;
    const auto hit = tree_.nearest(turned(axis, angle, spread_[i]), cap);
    sum += hit.triangle < 0 ? cap * cap : hit.squared;
  }
  return std::sqrt(sum / static_cast<double>(count));
}

// Unknowns: tilts about u and v, shifts along them. A tilted axis turns p by E R E^T with
// E = 1 + [w]: the image moves by w x R(p - o) - R(w x (p - o)); a shift t moves it by t - R t.
SymmetryAxis ShapeSymmetry::refined(SymmetryAxis axis,
                                    double angle,
                                    bool move_origin,
                                    bool tilt) const {
  const double c = std::cos(angle), s = std::sin(angle);
  // A few points find the place, all of them settle it.
  const std::size_t all = std::min(kRefineSamples, spread_.size());
  std::size_t count = std::min(kRoughSamples, all);
  std::vector<std::int32_t> last(all, -1);
  for (int iteration = 0; iteration < kMostIterations && (move_origin || tilt); ++iteration) {
    if (iteration == kMostRough) count = all;
    const Point3 d = axis.direction;
    const Point3 seed = std::abs(d.x) < 0.6 ? Point3{1, 0, 0} : Point3{0, 1, 0};
    Point3 u = cross(d, seed);
    u = (1 / length(u)) * u;
    const Point3 v = cross(d, u);
    struct Row {
      std::array<double, 4> slope;
      double residual;
    };
    std::vector<Row> rows;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < count; ++i) {
      const Point3 p = spread_[i] - axis.origin;
      const Point3 q = rotate_about(d, c, s, p);
      const auto hit = tree_.nearest(axis.origin + q, kPullReach * diameter_, last[i]);
      if (hit.triangle < 0) continue;
      const Point3 n = area_normal(surface_, surface_.triangles[hit.triangle]);
      const double l = length(n);
      if (!(l > 0)) continue;
      const auto slope = [&](Point3 move) { return dot(n, move) / l; };
      const auto tilted = [&](Point3 w) {
        return slope(cross(w, q) - rotate_about(d, c, s, cross(w, p)));
      };
      const auto shifted = [&](Point3 t) { return slope(t - rotate_about(d, c, s, t)); };
      // Tilts in units of diameters, so that all unknowns are lengths.
      rows.push_back({{tilt ? tilted(u) / diameter_ : 0, tilt ? tilted(v) / diameter_ : 0,
                       move_origin ? shifted(u) : 0, move_origin ? shifted(v) : 0},
                      dot(n, axis.origin + q - hit.point) / l});
      sizes.push_back(std::abs(rows.back().residual));
    }
    if (rows.size() < 8) break;
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    // Residuals beyond three medians count less and less.
    const double scale = std::max(3 * *middle, 1e-9 * diameter_);
    std::array<std::array<double, 5>, 4> m{};
    for (const Row& row : rows) {
      const double ratio = row.residual / scale;
      const double weight = 1 / (1 + ratio * ratio);
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) m[i][j] += weight * row.slope[i] * row.slope[j];
        m[i][4] -= weight * row.slope[i] * row.residual;
      }
    }
    // A trace of damping holds what the shape does not determine.
    const double trace = m[0][0] + m[1][1] + m[2][2] + m[3][3];
    for (std::size_t i = 0; i < 4; ++i) m[i][i] += 1e-9 * trace + 1e-300;
    std::array<double, 4> x{};
    if (!solve(m, x)) break;
    const Point3 direction =
        d + (x[0] / diameter_) * cross(u, d) + (x[1] / diameter_) * cross(v, d);
    axis.direction = (1 / length(direction)) * direction;
    axis.origin = axis.origin + x[2] * u + x[3] * v;
    const double step = std::abs(x[0]) + std::abs(x[1]) + std::abs(x[2]) + std::abs(x[3]);
    if (count < all && step < kRoughStep * diameter_) {
      count = all;
    } else if (step < kLeastStep * diameter_) {
      break;
    }
  }
  return axis;
}

}  // namespace symcell::solid
