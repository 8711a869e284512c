#include "api/formats/curve_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "core/geometry/arc.hpp"
#include "core/geometry/point_grid.hpp"

namespace symcell {
namespace {

constexpr double kSameEndRel = 1e-9;  // of the diameter: what drawings with ten digits keep
constexpr double kBesideRel = 1e-4;   // of an arc's length, from the curve it stands for
constexpr int kLeastDepth = 2;        // a curve may meet an arc by chance at the places looked at
constexpr int kMostDepth = 12;        // 4096 arcs a smooth piece
constexpr double kWidest = std::numbers::pi / 2;
constexpr double kCircular = 1e-12;  // by which axes of a circle differ but for rounding
constexpr std::size_t kMostCurves = 3 * kMaxPslgVertices;

// Of the circle from a to b through m; 0 if they are in line.
double bulge_through(Point2 a, Point2 m, Point2 b) {
  const Point2 u = m - a, v = b - m;
  // The tangent turns by half of the arc's angle from the one chord to the other.
  return std::tan(std::atan2(cross(u, v), dot(u, v)) / 2);
}

}  // namespace

void CurveDrawing::add_arc(Point2 a, Point2 b, double bulge, std::int32_t marker) {
  if (a != b && curves_.size() <= kMostCurves) curves_.push_back({a, b, bulge, marker});
}

void CurveDrawing::add_ellipse(
    Point2 centre, Point2 u, Point2 v, double from, double to, std::int32_t marker) {
  const auto at = [&](double t) { return centre + std::cos(t) * u + std::sin(t) * v; };
  const double size = squared_length(u) + squared_length(v);
  const bool circular = std::abs(dot(u, v)) <= kCircular * size &&
                        std::abs(squared_length(u) - squared_length(v)) <= kCircular * size;
  const bool whole = std::abs(to - from) >= 2 * std::numbers::pi * (1 - kSameEndRel);
  if (whole) to = from + std::copysign(2 * std::numbers::pi, to - from);
  if (!circular) {
    // In quarters, so that equal ellipses are cut alike whatever their first angle is.
    const int parts = whole ? 4 : 1;
    for (int i = 0; i < parts; ++i) {
      const double step = (to - from) / parts;
      add_through(at, from + i * step, from + (i + 1) * step, marker, 0);
    }
    return;
  }
  const double sense = cross(u, v) > 0 ? 1 : -1;
  if (!whole) return add_arc(at(from), at(to), bulge_of_angle(sense * (to - from)), marker);
  const double middle = from + (to - from) / 2;
  const double half = std::copysign(1, sense * (to - from));
  add_arc(at(from), at(middle), half, marker);
  add_arc(at(middle), at(from), half, marker);
}

void CurveDrawing::add_curve(const std::function<Point2(double)>& at,
                             double from,
                             double to,
                             std::int32_t marker) {
  add_through(at, from, to, marker, 0);
}

void CurveDrawing::add_through(const std::function<Point2(double)>& at,
                               double from,
                               double to,
                               std::int32_t marker,
                               int depth) {
  if (curves_.size() > kMostCurves) return;
  const double middle = from + (to - from) / 2;
  const Point2 a = at(from), m = at(middle), b = at(to);
  const double bulge = bulge_through(a, m, b);
  const double angle = angle_of_bulge(bulge);
  const auto off_arc = [&](double share) {
    const Point2 p = at(from + share * (to - from));
    if (bulge == 0) return std::abs(cross(b - a, p - a)) / std::max(distance(a, b), 1e-300);
    return std::abs(distance(p, arc_centre(a, b, bulge)) - arc_radius(a, b, bulge));
  };
  bool close = depth >= kLeastDepth && std::abs(angle) <= kWidest;
  if (close) {
    const double most = kBesideRel * distance(a, b);
    close = off_arc(0.25) <= most && off_arc(0.75) <= most;
  }
  if (close || depth == kMostDepth) return add_arc(a, b, bulge, marker);
  add_through(at, from, middle, marker, depth + 1);
  add_through(at, middle, to, marker, depth + 1);
}

Result<void> CurveDrawing::finish(Pslg& pslg) const {
  if (curves_.size() > kMostCurves) {
    return fail(ErrorCode::kTooLarge, "the drawing has more than " + std::to_string(kMostCurves) +
                                          " lines and arcs; simplify it");
  }
  if (curves_.empty()) return {};
  Point2 low = curves_.front().a, high = low;
  for (const Curve& c : curves_) {
    for (const Point2 p : {c.a, c.b}) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
  const double radius = kSameEndRel * distance(low, high);
  PointGrid grid(radius > 0 ? radius : 1, 2 * curves_.size());
  const auto vertex = [&](Point2 p) {
    std::int32_t v = grid.nearest(p);
    if (v >= 0) return v;
    v = static_cast<std::int32_t>(pslg.vertices.size());
    grid.insert(p, v);
    pslg.vertices.push_back(p);
    return v;
  };
  struct Placed {
    std::int32_t low, high;
    double bulge;  // from low to high
    std::int32_t marker;
    std::size_t curve;
    PslgSegment segment;
  };
  std::vector<Placed> placed;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    const Curve& c = curves_[i];
    const std::int32_t a = vertex(c.a), b = vertex(c.b);
    if (a == b) continue;
    placed.push_back({std::min(a, b),
                      std::max(a, b),
                      a < b ? c.bulge : -c.bulge,
                      c.marker,
                      i,
                      {a, b, c.marker}});
  }
  // Drawn twice: next to each other by ends, marker and bulge.
  std::sort(placed.begin(), placed.end(), [](const Placed& x, const Placed& y) {
    return std::tie(x.low, x.high, x.marker, x.bulge, x.curve) <
           std::tie(y.low, y.high, y.marker, y.bulge, y.curve);
  });
  const auto twice = [](const Placed& x, const Placed& y) {
    return x.low == y.low && x.high == y.high && x.marker == y.marker &&
           std::abs(x.bulge - y.bulge) <= kSameEndRel * (1 + std::abs(x.bulge));
  };
  placed.erase(std::unique(placed.begin(), placed.end(), twice), placed.end());
  std::sort(placed.begin(), placed.end(),
            [](const Placed& x, const Placed& y) { return x.curve < y.curve; });
  for (const Placed& p : placed) {
    pslg.segments.push_back(p.segment);
    pslg.bulges.push_back(p.segment.a == p.low ? p.bulge : -p.bulge);
  }
  if (!pslg.has_arcs()) pslg.bulges.clear();
  return {};
}

}  // namespace symcell
