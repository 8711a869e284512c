#include "core/geometry/surface_distance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/spatial_order.hpp"

namespace symcell {
namespace {

// Shares of the reach: parts smaller than this are not taken apart; and where the middle of a part is
// beside its nearest triangle by less than this, the part is cut so far beside it.
constexpr double kSmallestPart = 1.0 / 64;
constexpr double kWidened = 1.0 / 16;
// A triangle is cut out by its own outline where it is not steeper than 60 degrees.
constexpr double kSteepCosine = 0.5;
// A triangle beside as many as this is not known; a part takes some microseconds.
constexpr std::size_t kMostParts = 100'000;
constexpr std::size_t kMostPartsInAll = 5'000'000;

Point3 middle_of(const std::vector<Point3>& part) {
  Point3 sum;
  for (const Point3& p : part) sum = sum + p;
  return (1.0 / static_cast<double>(part.size())) * sum;
}

double squared_radius(const std::vector<Point3>& part, Point3 middle) {
  double most = 0;
  for (const Point3& p : part) most = std::max(most, squared_distance(p, middle));
  return most;
}

// The parts of a convex polygon below and above the plane through `on` with this normal; a polygon in
// the plane is below.
void cut(const std::vector<Point3>& part,
         Point3 on,
         Point3 normal,
         std::vector<Point3>& below,
         std::vector<Point3>& above) {
  below.clear();
  above.clear();
  if (part.empty()) return;
  const auto height = [&](const Point3& p) { return dot(p - on, normal); };
  Point3 from = part.back();
  double start = height(from), lowest = start, highest = start;
  for (const Point3& to : part) {
    const double end = height(to);
    if ((start < 0 && end > 0) || (start > 0 && end < 0)) {
      const Point3 p = from + (start / (start - end)) * (to - from);
      below.push_back(p);
      above.push_back(p);
    }
    if (end <= 0) below.push_back(to);
    if (end >= 0) above.push_back(to);
    from = to;
    start = end;
    lowest = std::min(lowest, end);
    highest = std::max(highest, end);
  }
  if (below.size() < 3 || (lowest >= 0 && highest > 0)) below.clear();
  if (above.size() < 3 || highest <= 0) above.clear();
}

constexpr auto kIsNearer = [](const auto& part, const auto& other) {
  return part.squared < other.squared;
};

}  // namespace

std::vector<Point3> samples_of(const IndexedSurface& surface) {
  std::vector<Point3> samples = surface.points;
  samples.reserve(samples.size() + 5 * surface.triangles.size() / 2);
  for (const Triangle& t : surface.triangles) {
    const std::array<Point3, 3> p = {surface.points[t[0]], surface.points[t[1]],
                                     surface.points[t[2]]};
    samples.push_back((1.0 / 3) * (p[0] + p[1] + p[2]));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (t[i] < t[j]) samples.push_back(0.5 * (p[i] + p[j]));  // from one of two triangles
    }
  }
  sort_along_hilbert_curve(samples);
  return samples;
}

std::optional<Point3> DistanceBound::beyond(const std::array<Point3, 3>& triangle) {
  if (is_near_at(triangle)) return std::nullopt;  // most triangles, after a neighbour
  parts_.clear();
  found_.reset();
  normal_ = area_normal(triangle[0], triangle[1], triangle[2]);
  look_at(Polygon(triangle.begin(), triangle.end()));
  for (std::size_t taken = 0; !found_ && !parts_.empty(); ++taken) {
    if (taken == kMostParts || in_all_ >= kMostPartsInAll) break;
    std::pop_heap(parts_.begin(), parts_.end(), kIsNearer);
    const Part part = std::move(parts_.back());
    parts_.pop_back();
    last_ = part.nearest;
    take_apart(part);
  }
  return found_;
}

bool DistanceBound::is_near_at(std::span<const Point3> corners) const {
  if (last_ < 0) return false;
  const std::array<Point3, 3> at = surface_->corners_at(last_);
  return std::all_of(corners.begin(), corners.end(), [&](const Point3& p) {
    return squared_distance(p, closest_point(p, at[0], at[1], at[2])) <= reach_ * reach_;
  });
}

// Finds a point beyond, knows that there is none, or keeps the part to be taken apart.
void DistanceBound::look_at(Polygon corners) {
  if (corners.empty() || is_near_at(corners)) return;
  ++in_all_;
  const Point3 middle = middle_of(corners);
  const auto hit = surface_->nearest(middle, reach_, last_);
  if (hit.triangle < 0) {
    found_ = middle;
    return;
  }
  const double radius = std::sqrt(squared_radius(corners, middle));
  if (std::sqrt(hit.squared) + radius <= reach_ || is_near_at(corners)) return;
  if (radius <= kSmallestPart * reach_) {
    found_ = middle;
    return;
  }
  parts_.push_back({std::move(corners), middle, hit.squared, last_});
  std::push_heap(parts_.begin(), parts_.end(), kIsNearer);
}

void DistanceBound::take_apart(const Part& part) {
  if (!cut_out(part)) halve(part.corners, part.middle);
}

// Cuts what lies over the nearest triangle out of a part; where it is not near, it is halved. False: the
// middle is beside the triangle, or the triangle is steep, and nothing was done.
bool DistanceBound::cut_out(const Part& part) {
  const std::array<Point3, 3> corners = surface_->corners_at(last_);
  const Point3 normal = area_normal(corners[0], corners[1], corners[2]);
  if (!(std::abs(dot(normal, normal_)) > kSteepCosine * length(normal) * length(normal_)))
    return false;
  std::array<Point3, 3> outwards;
  double beside = 0;  // how far the middle is
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 across = cross(corners[(i + 1) % 3] - corners[i], normal);
    const double size = length(across);
    if (!(size > 0)) return false;
    outwards[i] = (1 / size) * across;
    beside = std::max(beside, dot(part.middle - corners[i], outwards[i]));
  }
  if (beside > kWidened * reach_) return false;
  const double widened = beside > 0 ? kWidened * reach_ : 0;
  Polygon rest = part.corners, inside;
  std::array<Polygon, 3> around;
  for (std::size_t i = 0; i < 3; ++i) {
    cut(rest, corners[i] + widened * outwards[i], outwards[i], inside, around[i]);
    std::swap(rest, inside);
  }
  if (rest.empty()) return false;  // by rounding
  if (!is_near_at(rest)) halve(rest, middle_of(rest));
  for (Polygon& p : around) look_at(std::move(p));
  return true;
}

// Across the longest of the ways from the middle to a corner.
void DistanceBound::halve(const Polygon& corners, Point3 middle) {
  const auto farthest =
      std::max_element(corners.begin(), corners.end(), [&](const Point3& p, const Point3& q) {
        return squared_distance(p, middle) < squared_distance(q, middle);
      });
  Polygon below, above;
  cut(corners, middle, *farthest - middle, below, above);
  look_at(std::move(below));
  look_at(std::move(above));
}

}  // namespace symcell
