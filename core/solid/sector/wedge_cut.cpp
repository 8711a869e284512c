#include "core/solid/sector/wedge_cut.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace symcell::solid {
namespace {

// Points nearer to the axis than this, of the extent, are on it: an edge through the axis crosses
// it but for rounding of single precision.
constexpr double kAxisRel = 1e-7;

struct PlaneDirection {
  double cosine, sine;
  explicit PlaneDirection(double angle) : cosine(std::cos(angle)), sine(std::sin(angle)) {}
  // Along the half-plane, away from the axis.
  [[nodiscard]] double radius(Point3 p) const { return cosine * p.x + sine * p.y; }
  // Normal to it, counter-clockwise.
  [[nodiscard]] double height(Point3 p) const { return cosine * p.y - sine * p.x; }
  [[nodiscard]] Point3 at(double r, double z) const { return {cosine * r, sine * r, z}; }
};

// 2 * area / longest side^2 of the flatter of the triangles abc and acd.
double worse_shape(Point3 a, Point3 b, Point3 c, Point3 d) {
  const auto shape = [](Point3 p, Point3 q, Point3 r) {
    const double longest =
        std::max({squared_distance(p, q), squared_distance(q, r), squared_distance(r, p)});
    return longest > 0 ? length(area_normal(p, q, r)) / longest : 0;
  };
  return std::min(shape(a, b, c), shape(a, c, d));
}

// No vertex is moved by more than this share of the sector's width there.
constexpr double kSnapArc = 0.1;

class Cutter {
 public:
  Cutter(const IndexedSurface& surface, std::int32_t fold, double start_angle, double snap)
      : fold_(fold),
        lower_(start_angle),
        upper_(start_angle + 2 * std::numbers::pi / fold),
        snap_(snap) {
    double extent = 0;
    for (const Point3& p : surface.points) extent = std::max(extent, std::hypot(p.x, p.y));
    axis_snap_ = std::max(snap, kAxisRel * extent);
    patch_.fold = fold;
    patch_.start_angle = start_angle;
    patch_.points = surface.points;
    patch_.on_lower.assign(surface.points.size(), 0);
    patch_.on_higher.assign(surface.points.size(), 0);
    patch_.triangles = surface.triangles;
    patch_.normals.reserve(surface.triangles.size());
    for (const Triangle& t : surface.triangles) {
      const Point3 n = area_normal(surface, t);
      const double l = length(n);
      patch_.normals.push_back(l > 0 ? (1 / l) * n : Point3{});
    }
  }

  Result<WedgePatch> run() {
    snap_vertices();
    bool flat = false;
    if (fold_ == 2) {
      flat = !split(&Cutter::above_lower, true);
      flat = !split(&Cutter::along_plane, false) || flat;
      mark_halves();
    } else {
      flat = !split(&Cutter::above_lower, true);
      flat = !split(&Cutter::below_upper, true) || flat;
    }
    if (flat || patch_.triangles.empty()) {
      return fail(ErrorCode::kInternal, "a triangle lies in the half-plane of the cut");
    }
    drop_unused();
    return std::move(patch_);
  }

 private:
  using Value = double (Cutter::*)(std::int32_t) const;

  [[nodiscard]] const Point3& point(std::int32_t v) const { return patch_.points[v]; }
  [[nodiscard]] double above_lower(std::int32_t v) const {
    return patch_.on_lower[v] != 0 ? 0 : lower_.height(point(v));
  }
  [[nodiscard]] double below_upper(std::int32_t v) const {
    return patch_.on_higher[v] != 0 ? 0 : -upper_.height(point(v));
  }
  // Fold 2: of vertices in the plane, on which side of the axis.
  [[nodiscard]] double along_plane(std::int32_t v) const {
    return patch_.on_lower[v] == 0 || patch_.on_higher[v] != 0 ? 0 : lower_.radius(point(v));
  }

  void put_on_axis(std::int32_t v) {
    patch_.points[v] = {0, 0, patch_.points[v].z};
    patch_.on_lower[v] = patch_.on_higher[v] = 1;
  }
  void put_on_lower(std::int32_t v) {
    patch_.points[v] = lower_.at(lower_.radius(point(v)), point(v).z);
    patch_.on_lower[v] = 1;
  }
  void put_on_upper(std::int32_t v) {
    patch_.points[v] = upper_.at(upper_.radius(point(v)), point(v).z);
    patch_.on_higher[v] = 1;
  }

  // Less near the axis, where the sector is narrow.
  [[nodiscard]] double snap_at(Point3 p) const {
    const double arc = 2 * std::numbers::pi / fold_ * std::hypot(p.x, p.y);
    return std::min(snap_, kSnapArc * arc);
  }

  void snap_vertices() {
    for (std::size_t i = 0; i < patch_.points.size(); ++i) {
      const auto v = static_cast<std::int32_t>(i);
      const Point3 p = point(v);
      if (std::hypot(p.x, p.y) <= axis_snap_) {
        put_on_axis(v);
      } else if (std::abs(lower_.height(p)) <= snap_at(p) && (fold_ == 2 || lower_.radius(p) > 0)) {
        put_on_lower(v);
      } else if (std::abs(upper_.height(p)) <= snap_at(p) && upper_.radius(p) > 0) {
        put_on_upper(v);
      }
    }
  }

  // Cuts all triangles where `value` changes its sign; `filter`: what has no positive corner goes.
  // False if a triangle is zero at all corners.
  bool split(Value value, bool filter) {
    bool sound = true;
    struct Crossing {
      std::int32_t low, high, vertex;
    };
    std::vector<Crossing> crossings;
    std::vector<double> values(patch_.points.size());
    for (std::size_t v = 0; v < values.size(); ++v) {
      values[v] = (this->*value)(static_cast<std::int32_t>(v));
    }
    for (const Triangle& t : patch_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = t[i], b = t[(i + 1) % 3];
        if (a < b && values[a] * values[b] < 0) crossings.push_back({a, b, -1});
        if (a > b && values[a] * values[b] < 0) crossings.push_back({b, a, -1});
      }
    }
    const auto before = [](const Crossing& x, const Crossing& y) {
      return x.low != y.low ? x.low < y.low : x.high < y.high;
    };
    std::sort(crossings.begin(), crossings.end(), before);
    crossings.erase(std::unique(crossings.begin(), crossings.end(),
                                [](const Crossing& x, const Crossing& y) {
                                  return x.low == y.low && x.high == y.high;
                                }),
                    crossings.end());
    for (Crossing& c : crossings) c.vertex = cross(c.low, c.high, values, value);
    const auto crossing = [&](std::int32_t a, std::int32_t b) {
      const Crossing key{std::min(a, b), std::max(a, b), -1};
      return std::lower_bound(crossings.begin(), crossings.end(), key, before)->vertex;
    };
    std::vector<Triangle> triangles;
    std::vector<Point3> normals;
    for (std::size_t k = 0; k < patch_.triangles.size(); ++k) {
      const Triangle t = patch_.triangles[k];
      const Point3 normal = patch_.normals[k];
      const auto keep = [&](const std::vector<std::int32_t>& polygon) {
        add_polygon(polygon, normal, triangles, normals);
      };
      const double v0 = values[t[0]], v1 = values[t[1]], v2 = values[t[2]];
      const bool positive = v0 > 0 || v1 > 0 || v2 > 0;
      const bool negative = v0 < 0 || v1 < 0 || v2 < 0;
      if (!positive && !negative && filter) sound = false;
      if (filter && !positive) continue;
      if (!positive || !negative) {
        keep({t[0], t[1], t[2]});
        continue;
      }
      std::vector<std::int32_t> above, below;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = t[i], b = t[(i + 1) % 3];
        if (values[a] >= 0) above.push_back(a);
        if (values[a] <= 0) below.push_back(a);
        if (values[a] * values[b] < 0) {
          above.push_back(crossing(a, b));
          below.push_back(above.back());
        }
      }
      keep(above);
      if (!filter) keep(below);
    }
    patch_.triangles = std::move(triangles);
    patch_.normals = std::move(normals);
    return sound;
  }

  std::int32_t cross(std::int32_t a,
                     std::int32_t b,
                     const std::vector<double>& values,
                     Value value) {
    const double t = values[a] / (values[a] - values[b]);
    const auto v = static_cast<std::int32_t>(patch_.points.size());
    patch_.points.push_back(point(a) + t * (point(b) - point(a)));
    // A crossing of an edge that lies in one plane already is on the axis.
    const bool on_lower = patch_.on_lower[a] != 0 && patch_.on_lower[b] != 0;
    const bool on_higher = patch_.on_higher[a] != 0 && patch_.on_higher[b] != 0;
    patch_.on_lower.push_back(0);
    patch_.on_higher.push_back(0);
    const Point3& p = point(v);
    if (std::hypot(p.x, p.y) <= axis_snap_ || value == &Cutter::along_plane ||
        (value == &Cutter::below_upper && on_lower) ||
        (value == &Cutter::above_lower && on_higher)) {
      put_on_axis(v);
    } else if (value == &Cutter::above_lower) {
      put_on_lower(v);
    } else {
      put_on_upper(v);
    }
    return v;
  }

  void add_polygon(const std::vector<std::int32_t>& p,
                   Point3 normal,
                   std::vector<Triangle>& triangles,
                   std::vector<Point3>& normals) const {
    if (p.size() < 3) return;
    if (p.size() == 3) {
      triangles.push_back({p[0], p[1], p[2]});
    } else {
      const Point3 a = point(p[0]), b = point(p[1]), c = point(p[2]), d = point(p[3]);
      if (worse_shape(a, b, c, d) >= worse_shape(b, c, d, a)) {
        triangles.push_back({p[0], p[1], p[2]});
        triangles.push_back({p[0], p[2], p[3]});
      } else {
        triangles.push_back({p[1], p[2], p[3]});
        triangles.push_back({p[1], p[3], p[0]});
      }
      normals.push_back(normal);
    }
    normals.push_back(normal);
  }

  // Fold 2: one plane, two half-planes.
  void mark_halves() {
    for (std::size_t v = 0; v < patch_.points.size(); ++v) {
      if (patch_.on_lower[v] == 0 || patch_.on_higher[v] != 0) continue;
      if (lower_.radius(patch_.points[v]) > 0) continue;
      patch_.on_lower[v] = 0;
      patch_.on_higher[v] = 1;
    }
  }

  void drop_unused() {
    std::vector<std::int32_t> number(patch_.points.size(), -1);
    for (const Triangle& t : patch_.triangles) {
      for (const std::int32_t v : t) number[v] = 0;
    }
    std::int32_t next = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] < 0) continue;
      patch_.points[next] = patch_.points[v];
      patch_.on_lower[next] = patch_.on_lower[v];
      patch_.on_higher[next] = patch_.on_higher[v];
      number[v] = next++;
    }
    const auto count = static_cast<std::size_t>(next);
    patch_.points.resize(count);
    patch_.on_lower.resize(count);
    patch_.on_higher.resize(count);
    for (Triangle& t : patch_.triangles) {
      for (std::int32_t& v : t) v = number[v];
    }
  }

  std::int32_t fold_;
  PlaneDirection lower_;
  PlaneDirection upper_;
  double snap_;
  double axis_snap_;
  WedgePatch patch_;
};

}  // namespace

Result<WedgePatch> cut_wedge(const IndexedSurface& surface,
                             std::int32_t fold,
                             double start_angle,
                             double snap) {
  return Cutter(surface, fold, start_angle, snap).run();
}

}  // namespace symcell::solid
