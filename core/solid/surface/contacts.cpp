#include "core/solid/surface/contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/geometry/triangle_tree.hpp"
#include "core/solid/surface/sheets.hpp"
#include "core/solid/surface/weld.hpp"

namespace symcell::solid {
namespace {

// More pairs of near triangles are no contacts of bodies but bodies drawn twice.
constexpr std::size_t kMostPairs = 200'000;
constexpr std::size_t kCheckEvery = 4096;  // pairs of boxes
// A triangle lower than so many times the reach has no plane that its rounded corners tell, and a plane
// is believed up to so many heights of the triangle away from it.
constexpr double kLeastHeight = 30;
constexpr double kMostHeights = 30;
// Cosine from which on two planes are one.
constexpr double kSamePlane = 1 - 1e-6;
// What a corner between planes may move, in reaches: at edges of 30 degrees and more it does.
constexpr double kMostMove = 8;

// The least distance of two segments that are not parallel; infinity where it is reached at an end.
double distance_inside(Point3 a, Point3 b, Point3 c, Point3 d) {
  const Point3 u = b - a, v = d - c, w = a - c;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double det = uu * vv - uv * uv;
  const double s = uv * vw - vv * uw, t = uu * vw - uv * uw;
  if (!(s >= 0 && s <= det && t >= 0 && t <= det && det > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  return length(w + (s / det) * u - (t / det) * v);
}

using Corners = std::array<Point3, 3>;

bool within_reach(const Corners& s, const Corners& t, double reach) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (distance(s[i], closest_point(s[i], t[0], t[1], t[2])) <= reach) return true;
    if (distance(t[i], closest_point(t[i], s[0], s[1], s[2])) <= reach) return true;
    for (std::size_t j = 0; j < 3; ++j) {
      if (distance_inside(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]) <= reach) return true;
    }
  }
  return false;
}

class Contacts {
 public:
  Contacts(IndexedSurface& surface, double reach, ExecutionContext& context)
      : surface_(surface), reach_(reach), context_(context) {}

  Result<std::vector<Point3>> run() {
    auto bodies = bodies_of(surface_);
    // What is open has no bodies; others tell of it.
    if (!bodies) return std::vector<Point3>{};
    body_ = std::move(*bodies);
    if (std::ranges::all_of(body_, [&](std::int32_t b) { return b == body_.front(); })) {
      return std::vector<Point3>{};
    }
    find_filled();
    own_points();
    find_neighbours();
    auto found = find_planes();
    if (!found) return error_of(found);
    if (!*found) return std::vector<Point3>{};
    return moved();
  }

 private:
  struct Plane {
    Point3 normal;  // of length 1
    Point3 at;
  };
  struct PlaneAt {
    std::int32_t point;
    Plane plane;
    double height;  // of the point
  };

  void find_filled() {
    filled_.assign(body_.size(), 0);
    std::vector<std::vector<Point3>> corners(body_.size());
    const Point3 origin = surface_.points.front();
    for (std::size_t t = 0; t < body_.size(); ++t) {
      const Triangle& v = surface_.triangles[t];
      filled_[body_[t]] += dot(surface_.points[v[0]] - origin, area_normal(surface_, v));
      for (const std::int32_t p : v) corners[body_[t]].push_back(surface_.points[p]);
    }
    boxes_.resize(body_.size());
    for (std::size_t b = 0; b < corners.size(); ++b) {
      if (!corners[b].empty()) boxes_[b] = bounding_box(corners[b]);
    }
  }

  // Whether corners of triangle s may go into what t bounds. Hollows do not move. A wall between a hollow
  // and the outside may be thin, and look like two bodies that overlap: what has the hollow in it does
  // not touch it.
  [[nodiscard]] bool may_touch(std::int32_t s, std::int32_t t) const {
    const std::int32_t body = body_[s], other = body_[t];
    if (body == other || !(filled_[body] > 0)) return false;
    return filled_[other] > 0 || !boxes_[body].encloses(boxes_[other]);
  }

  // Bodies that share corners get their own.
  void own_points() {
    own_ = surface_;
    std::vector<std::pair<std::int64_t, std::int32_t>> uses;  // (body, point), number there
    const auto key = [&](std::size_t t, std::size_t i) {
      return (static_cast<std::int64_t>(body_[t]) << 32) | surface_.triangles[t][i];
    };
    for (std::size_t t = 0; t < body_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) uses.emplace_back(key(t, i), 0);
    }
    std::sort(uses.begin(), uses.end());
    uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
    std::vector<bool> taken(surface_.points.size(), false);
    for (auto& [k, number] : uses) {
      const auto point = static_cast<std::int32_t>(k & 0xffffffff);
      number = point;
      if (taken[point]) {
        number = static_cast<std::int32_t>(own_.points.size());
        own_.points.push_back(surface_.points[point]);
      }
      taken[point] = true;
    }
    for (std::size_t t = 0; t < body_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        own_.triangles[t][i] =
            std::lower_bound(uses.begin(), uses.end(), std::pair{key(t, i), std::int32_t{0}})
                ->second;
      }
    }
  }

  void find_neighbours() {
    neighbours_.resize(own_.points.size());
    for (const Triangle& t : own_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) neighbours_[t[i]].push_back(t[(i + 1) % 3]);
    }
  }

  [[nodiscard]] Corners corners(std::int32_t t) const {
    const Triangle& v = own_.triangles[t];
    return {own_.points[v[0]], own_.points[v[1]], own_.points[v[2]]};
  }

  [[nodiscard]] double height(const Plane& plane, std::int32_t v) const {
    return dot(own_.points[v] - plane.at, plane.normal);
  }

  // Notes the plane of t for those corners of s that touch it from outside; with `far` also for those that
  // touch only the plane, beyond the triangle.  Returns how many there are.
  std::size_t look_at(std::int32_t s, std::int32_t t, bool far) {
    if (!may_touch(s, t)) return 0;
    const Corners c = corners(t);
    const Point3 n = area_normal(c[0], c[1], c[2]);
    const double longest =
        std::max({distance(c[0], c[1]), distance(c[1], c[2]), distance(c[2], c[0])});
    const double least_height = length(n) / longest;
    if (!(least_height >= kLeastHeight * reach_)) return 0;
    const Plane plane{(1 / length(n)) * n, c[0]};
    const double most = far ? kMostHeights * least_height : reach_;
    std::size_t count = 0;
    for (const std::int32_t v : own_.triangles[s]) {
      const double h = height(plane, v);
      const Point3& p = own_.points[v];
      if (!(std::abs(h) <= reach_)) continue;
      if (distance(p, closest_point(p, c[0], c[1], c[2])) > most) continue;
      const bool outside = std::ranges::all_of(neighbours_[v], [&](std::int32_t w) {
        // Far away the plane is known less well.
        const double heights = distance(own_.points[w], p) / least_height;
        return height(plane, w) >= -reach_ * (1 + heights);
      });
      if (!outside) continue;
      planes_.push_back({v, plane, h});
      ++count;
    }
    return count;
  }

  // False: nothing touches, or all exactly.
  Result<bool> find_planes() {
    std::vector<std::pair<std::int32_t, std::int32_t>> near;
    std::size_t looked_at = 0;
    Result<void> state;
    const TriangleTree tree(own_.points, own_.triangles);
    tree.visit_meeting_boxes(
        [&](std::int32_t s, std::int32_t t) {
          if (++looked_at % kCheckEvery == 0) {
            state = context_.check();
            if (!state) return true;
          }
          if (!may_touch(s, t) && !may_touch(t, s)) return false;
          if (within_reach(corners(s), corners(t), reach_)) near.emplace_back(s, t);
          return near.size() > kMostPairs;
        },
        reach_);
    if (!state) return error_of(state);
    if (near.size() > kMostPairs) return false;
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (i % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      const auto [s, t] = near[i];
      if (look_at(s, t, false) + look_at(t, s, false) > 0) continue;
      look_at(s, t, true);  // bodies that touch where neither has a corner, such as crossed bars
      look_at(t, s, true);
    }
    return std::any_of(planes_.begin(), planes_.end(),
                       [](const PlaneAt& at) { return at.height != 0; });
  }

  std::vector<Point3> moved() {
    std::vector<Point3> places;
    std::stable_sort(planes_.begin(), planes_.end(),
                     [](const PlaneAt& a, const PlaneAt& b) { return a.point < b.point; });
    for (auto begin = planes_.begin(); begin != planes_.end();) {
      const std::int32_t v = begin->point;
      std::vector<Plane> different;
      for (; begin != planes_.end() && begin->point == v; ++begin) {
        if (std::none_of(different.begin(), different.end(), [&](const Plane& other) {
              return dot(other.normal, begin->plane.normal) > kSamePlane;
            })) {
          different.push_back(begin->plane);
        }
      }
      const Point3 from = own_.points[v];
      Point3 p = from;
      // Twice: a second plane may lift the corner over the first again.
      for (int round = 0; round < 2; ++round) {
        for (const Plane& plane : different) {
          const double above = dot(p - plane.at, plane.normal) + reach_;
          if (above > 0) p = p - above * plane.normal;
        }
      }
      if (distance(p, from) > kMostMove * reach_) continue;
      own_.points[v] = p;
      places.push_back(from);
    }
    // Corners that stayed are shared again.
    if (!places.empty()) surface_ = weld_exactly(own_);
    return places;
  }

  IndexedSurface& surface_;
  double reach_;
  ExecutionContext& context_;
  IndexedSurface own_;                                 // no two bodies share a corner
  std::vector<std::int32_t> body_;                     // per triangle
  std::vector<double> filled_;                         // per body: six times its volume
  std::vector<Box3> boxes_;                            // likewise
  std::vector<std::vector<std::int32_t>> neighbours_;  // per corner, over edges
  std::vector<PlaneAt> planes_;
};

}  // namespace

Result<std::vector<Point3>> deepen_contacts(IndexedSurface& surface,
                                            double reach,
                                            ExecutionContext& context) {
  return Contacts(surface, reach, context).run();
}

}  // namespace symcell::solid
