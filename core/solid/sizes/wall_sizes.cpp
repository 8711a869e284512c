#include "core/solid/sizes/wall_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace symcell::solid {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr std::int32_t kLeafSize = 4;
// Cosine: a wall looks back within 60 degrees; what does not is an edge's other side.
constexpr double kOpposite = -0.5;
// Rays begin so much of the extent behind the surface: past the triangle itself and its neighbours.
constexpr double kBehind = 1e-6;
// Of the area: thinner places are too few to be a wall.
constexpr double kFew = 1e-3;
// Of the extent, at least: below it a preset would ask for millions of elements.
constexpr double kThinnest = 1.0 / 500;
constexpr std::size_t kCheckedEach = 256;
// Shares of the corners: where the thickness of a triangle is looked at.
constexpr std::array<std::array<double, 3>, 4> kPlaces = {
    {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.8, 0.1, 0.1}, {0.1, 0.8, 0.1}, {0.1, 0.1, 0.8}}};

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

double part(Point3 p, int axis) {
  return axis == 0 ? p.x : (axis == 1 ? p.y : p.z);
}

// The first triangle that a ray meets: a tree of boxes.
class Rays {
 public:
  explicit Rays(const IndexedSurface& surface) : s_(surface) {
    order_.resize(surface.triangles.size());
    for (std::size_t t = 0; t < order_.size(); ++t) order_[t] = static_cast<std::int32_t>(t);
    if (!order_.empty()) build(0, static_cast<std::int32_t>(order_.size()));
  }

  struct Hit {
    std::int32_t triangle = -1;
    double distance = kNone;
  };
  // `direction`: of length 1.
  [[nodiscard]] Hit first(Point3 from, Point3 direction) const {
    Hit hit;
    if (!nodes_.empty()) look_at(0, from, direction, hit);
    return hit;
  }

 private:
  struct Node {
    Point3 low, high;
    std::int32_t first = 0, last = 0, right = 0;
  };

  [[nodiscard]] Point3 corner(std::int32_t t, std::size_t i) const {
    return s_.points[at(s_.triangles[at(t)][i])];
  }
  [[nodiscard]] Point3 sum(std::int32_t t) const {
    return corner(t, 0) + corner(t, 1) + corner(t, 2);
  }

  std::int32_t build(std::int32_t first, std::int32_t last) {
    const auto id = static_cast<std::int32_t>(nodes_.size());
    Node node{corner(order_[at(first)], 0), corner(order_[at(first)], 0), first, last, 0};
    for (std::int32_t k = first; k < last; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Point3 p = corner(order_[at(k)], i);
        node.low = {std::min(node.low.x, p.x), std::min(node.low.y, p.y),
                    std::min(node.low.z, p.z)};
        node.high = {std::max(node.high.x, p.x), std::max(node.high.y, p.y),
                     std::max(node.high.z, p.z)};
      }
    }
    nodes_.push_back(node);
    if (last - first <= kLeafSize) return id;
    const Point3 d = node.high - node.low;
    const int axis = d.x >= d.y && d.x >= d.z ? 0 : (d.y >= d.z ? 1 : 2);
    const std::int32_t middle = first + (last - first) / 2;
    std::nth_element(
        order_.begin() + first, order_.begin() + middle, order_.begin() + last,
        [&](std::int32_t a, std::int32_t b) { return part(sum(a), axis) < part(sum(b), axis); });
    build(first, middle);
    const std::int32_t right = build(middle, last);
    nodes_[at(id)].right = right;
    return id;
  }

  // Where the ray enters the box; kNone: it misses it, or not before `most`.
  [[nodiscard]] static double entry(const Node& node, Point3 from, Point3 d, double most) {
    double enter = 0, leave = most;
    for (int axis = 0; axis < 3; ++axis) {
      const double inverse = 1 / part(d, axis);
      double a = (part(node.low, axis) - part(from, axis)) * inverse;
      double b = (part(node.high, axis) - part(from, axis)) * inverse;
      if (a > b) std::swap(a, b);
      // Not a number where the ray runs within a side: no bound.
      if (a > enter) enter = a;
      if (b < leave) leave = b;
    }
    return enter <= leave ? enter : kNone;
  }

  void look_at(std::int32_t id, Point3 from, Point3 d, Hit& hit) const {
    const Node& node = nodes_[at(id)];
    if (node.right == 0) {
      for (std::int32_t k = node.first; k < node.last; ++k) meet(order_[at(k)], from, d, hit);
      return;
    }
    std::int32_t near = id + 1, far = node.right;
    double enter = entry(nodes_[at(near)], from, d, hit.distance);
    double other = entry(nodes_[at(far)], from, d, hit.distance);
    if (other < enter) {
      std::swap(near, far);
      std::swap(enter, other);
    }
    if (enter < hit.distance) look_at(near, from, d, hit);
    if (other < hit.distance) look_at(far, from, d, hit);
  }

  void meet(std::int32_t t, Point3 from, Point3 d, Hit& hit) const {
    const Point3 a = corner(t, 0), u = corner(t, 1) - a, v = corner(t, 2) - a;
    const Point3 p = cross(d, v);
    const double det = dot(u, p);
    if (det == 0) return;
    const Point3 w = from - a;
    const double s = dot(w, p) / det;
    const Point3 q = cross(w, u);
    const double r = dot(d, q) / det;
    if (s < 0 || r < 0 || s + r > 1) return;
    const double distance = dot(v, q) / det;
    if (distance > 0 && distance < hit.distance) hit = {t, distance};
  }

  const IndexedSurface& s_;
  std::vector<std::int32_t> order_;
  std::vector<Node> nodes_;
};

// The thickness below which the wall lies on no more than a few of the area.
double thinnest(const std::vector<SizeSource>& walls, const std::vector<double>& areas) {
  std::vector<std::pair<double, double>> sorted;
  double all = 0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    sorted.emplace_back(walls[i].size, areas[i]);
    all += areas[i];
  }
  std::sort(sorted.begin(), sorted.end());
  double sum = 0;
  for (const auto& [thickness, area] : sorted) {
    sum += area;
    if (sum > kFew * all) return thickness;
  }
  return 0;
}

}  // namespace

Result<std::vector<SizeSource>> wall_sizes(const IndexedSurface& surface,
                                           std::int32_t fold,
                                           double across,
                                           bool two_sided,
                                           ExecutionContext& context) {
  const Rays rays(surface);
  const double extent = bounding_box(surface.points).diagonal();
  std::vector<SizeSource> walls;
  std::vector<double> areas;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (t % kCheckedEach == 0) {
      SYMCELL_TRY(context.check());
    }
    const Triangle& c = surface.triangles[t];
    const std::array<Point3, 3> p{surface.points[at(c[0])], surface.points[at(c[1])],
                                  surface.points[at(c[2])]};
    const Point3 middle = (1.0 / 3) * (p[0] + p[1] + p[2]);
    double turn = std::atan2(middle.y, middle.x);
    if (turn < 0) turn += 2 * std::numbers::pi;
    if (turn * fold > 2 * std::numbers::pi) continue;
    const Point3 twice = area_normal(p[0], p[1], p[2]);
    const double area = length(twice);
    if (!(area > 0)) continue;
    double thickness = kNone;
    for (const double side : {-1.0, 1.0}) {
      if (side > 0 && !two_sided) break;
      const Point3 inwards = (side / area) * twice;
      for (const auto& w : kPlaces) {
        const Point3 from = w[0] * p[0] + w[1] * p[1] + w[2] * p[2] + kBehind * extent * inwards;
        const Rays::Hit hit = rays.first(from, inwards);
        if (hit.triangle < 0) continue;
        const Point3 other = area_normal(surface, surface.triangles[at(hit.triangle)]);
        const double cosine = -dot(other, inwards) / length(other);
        if ((two_sided ? -std::abs(cosine) : cosine) > kOpposite) continue;
        thickness = std::min(thickness, hit.distance);
      }
    }
    if (!std::isfinite(thickness)) continue;
    walls.push_back({p, thickness});
    areas.push_back(area);
  }
  const double least = std::max(thinnest(walls, areas), kThinnest * extent);
  for (SizeSource& w : walls) w.size = std::max(w.size, least) / across;
  return walls;
}

}  // namespace symcell::solid
