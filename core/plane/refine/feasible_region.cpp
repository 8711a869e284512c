#include "core/plane/refine/feasible_region.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace symcell::plane {
namespace {

// Points are sought for an angle this much above alpha, so that they pass the test for alpha
// whatever the rounding of the construction.
constexpr double kAngleSlack = 1e-9;
constexpr int kMaxCuts = 12;  // each leaves 5/9 of the polygon at most, so all a thousandth

Point2 centroid(const std::vector<Point2>& polygon) {
  Point2 sum{0, 0};
  double area = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Point2 u = polygon[i] - polygon[0], v = polygon[i + 1] - polygon[0];
    const double a = cross(u, v);
    area += a;
    sum = sum + a * (u + v);
  }
  if (area <= 0) return polygon[0];
  return polygon[0] + (1.0 / (3.0 * area)) * sum;
}

}  // namespace

FeasibleRegion::FeasibleRegion(double alpha, double max_edge2)
    : alpha_(alpha + kAngleSlack),
      sine_(std::sin(alpha_)),
      cosine_(std::cos(alpha_)),
      half_cotangent_(0.5 * cosine_ / sine_),
      half_cosecant_(0.5 / sine_),
      max_edge_(std::sqrt(max_edge2)),
      max_edge2_(max_edge2),
      most_edges_(static_cast<std::size_t>(2 * std::numbers::pi / alpha_)) {
}

FeasibleRegion::Disc FeasibleRegion::disc_of(const StarEdge& e) const {
  const Point2 d = e.b - e.a;
  const Point2 normal{-d.y, d.x};
  return {0.5 * (e.a + e.b) + half_cotangent_ * normal, half_cosecant_ * length(d)};
}

bool FeasibleRegion::clip(Point2 normal, double offset) {
  const std::size_t n = polygon_.size();
  side_.resize(n);
  bool any_out = false, any_in = false;
  for (std::size_t i = 0; i < n; ++i) {
    side_[i] = dot(normal, polygon_[i]) - offset;
    (side_[i] > 0 ? any_out : any_in) = true;
  }
  if (!any_out) return true;
  if (!any_in) return false;
  next_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = i + 1 == n ? 0 : i + 1;
    if (side_[i] <= 0) next_.push_back(polygon_[i]);
    if ((side_[i] > 0) != (side_[j] > 0)) {
      const double t = side_[i] / (side_[i] - side_[j]);
      next_.push_back(polygon_[i] + t * (polygon_[j] - polygon_[i]));
    }
  }
  polygon_.swap(next_);
  return polygon_.size() >= 3;
}

// Starts with the shortest edge, whose region is the smallest: its wedge, cut off where its disc
// ends. The rest follows longest first, because long edges keep x away and so show soonest that
// nothing is left.
bool FeasibleRegion::start(const std::vector<StarEdge>& edges, Point2 origin) {
  discs_.clear();
  order_.clear();
  std::size_t shortest = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    Disc d = disc_of(edges[i]);
    d.centre = d.centre - origin;
    discs_.push_back(d);
    if (d.radius < discs_[shortest].radius) shortest = i;
  }
  const Disc least = discs_[shortest];
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double reach = discs_[i].radius + least.radius;
    if (squared_distance(discs_[i].centre, least.centre) > reach * reach) return false;
    if (i == shortest) continue;
    std::size_t at = order_.size();
    order_.push_back(i);
    while (at > 0 && discs_[order_[at - 1]].radius < discs_[i].radius) {
      order_[at] = order_[at - 1];
      --at;
    }
    order_[at] = i;
  }
  const StarEdge& e = edges[shortest];
  const Point2 d = e.b - e.a, n{-d.y, d.x}, middle = 0.5 * (e.a + e.b) - origin;
  // In units of the edge: the wedge's apex, its sides where the disc ends, the top of the disc.
  const double tangent = sine_ / cosine_, r = half_cosecant_;
  const double low = (r + 0.5) * tangent, high = half_cotangent_ + r;
  polygon_.assign({middle + 0.5 * tangent * n, middle + r * d + low * n, middle + r * d + high * n,
                   middle - r * d + high * n, middle - r * d + low * n});
  if (e.max_area < kInfinity && !clip(n, dot(n, middle) + 2 * e.max_area)) return false;
  for (const StarEdge& s : edges) {
    const double reach = std::min(s.reach, max_edge_);
    if (reach < kInfinity) discs_.push_back({s.a - origin, reach});
  }
  return true;
}

bool FeasibleRegion::clip_by_wedges(const std::vector<StarEdge>& edges, Point2 origin) {
  for (const std::size_t i : order_) {
    const StarEdge& e = edges[i];
    const Point2 a = e.a - origin, b = e.b - origin;
    const Point2 d = b - a;
    // Right normals of the rays at alpha from a (along d) and, mirrored, from b (along -d).
    const Point2 ray_a{cosine_ * d.x - sine_ * d.y, sine_ * d.x + cosine_ * d.y};
    const Point2 ray_b{-cosine_ * d.x - sine_ * d.y, sine_ * d.x - cosine_ * d.y};
    const Point2 normal_a{ray_a.y, -ray_a.x}, normal_b{-ray_b.y, ray_b.x};
    if (!clip(normal_a, dot(normal_a, a)) || !clip(normal_b, dot(normal_b, b))) return false;
    if (e.max_area < kInfinity) {
      const Point2 normal{-d.y, d.x};
      if (!clip(normal, dot(normal, a) + 2 * e.max_area)) return false;
    }
  }
  return true;
}

// The triangles fill the polygon: none can be had if it is larger than all their area bounds.
bool FeasibleRegion::too_large(const std::vector<StarEdge>& edges, Point2 origin) {
  double doubled = 0, allowed = 0;
  for (const StarEdge& e : edges) {
    doubled += cross(e.a - origin, e.b - origin);
    allowed += e.max_area;
  }
  return doubled > 2 * allowed;
}

std::optional<Point2> FeasibleRegion::find(const std::vector<StarEdge>& edges) {
  if (edges.size() > most_edges_ || edges.size() < 3) return std::nullopt;
  // Near the origin, differences keep their digits.
  const Point2 origin = edges.front().a;
  if (too_large(edges, origin) || !start(edges, origin) || !clip_by_wedges(edges, origin))
    return std::nullopt;
  for (int cut = 0; cut < kMaxCuts; ++cut) {
    const Point2 x = centroid(polygon_);
    double worst = 0;
    const Disc* worst_disc = nullptr;
    for (const Disc& d : discs_) {
      const double excess = squared_distance(x, d.centre) - d.radius * d.radius;
      if (excess > worst) {
        worst = excess;
        worst_disc = &d;
      }
    }
    if (worst_disc == nullptr) return x + origin;
    const Point2 away = x - worst_disc->centre;
    const double r = length(away);
    if (!clip(away, dot(away, worst_disc->centre) + worst_disc->radius * r)) return std::nullopt;
  }
  return std::nullopt;
}

std::optional<Point2> FeasibleRegion::find_on_line(const std::vector<StarEdge>& edges,
                                                   Point2 p,
                                                   Point2 d) const {
  double low = 0, high = 1;
  const auto half_plane = [&](Point2 normal, double offset) {
    const double slope = dot(normal, d), value = dot(normal, p) - offset;
    if (slope > 0) {
      high = std::min(high, -value / slope);
    } else if (slope < 0) {
      low = std::max(low, -value / slope);
    } else if (value > 0) {
      high = -1;
    }
  };
  const auto disc = [&](Point2 centre, double radius) {
    const Point2 q = p - centre;
    const double a = squared_length(d), b = dot(q, d), c = squared_length(q) - radius * radius;
    const double discriminant = b * b - a * c;
    if (discriminant <= 0) {
      high = -1;
      return;
    }
    const double root = std::sqrt(discriminant);
    low = std::max(low, (-b - root) / a);
    high = std::min(high, (-b + root) / a);
  };
  for (const StarEdge& e : edges) {
    const Point2 v = e.b - e.a;
    const Point2 ray_a{cosine_ * v.x - sine_ * v.y, sine_ * v.x + cosine_ * v.y};
    const Point2 ray_b{-cosine_ * v.x - sine_ * v.y, sine_ * v.x - cosine_ * v.y};
    const Point2 normal_a{ray_a.y, -ray_a.x}, normal_b{-ray_b.y, ray_b.x};
    half_plane(normal_a, dot(normal_a, e.a));
    half_plane(normal_b, dot(normal_b, e.b));
    const Disc seen = disc_of(e);
    disc(seen.centre, seen.radius);
    if (e.max_area < kInfinity) {
      const Point2 normal{-v.y, v.x};
      half_plane(normal, dot(normal, e.a) + 2 * e.max_area);
    }
    if (max_edge2_ < kInfinity) {
      disc(e.a, max_edge_);
      disc(e.b, max_edge_);
    }
    if (e.reach < kInfinity) disc(e.a, e.reach);
    if (!(low < high)) return std::nullopt;
  }
  return p + 0.5 * (low + high) * d;
}

}  // namespace symcell::plane
