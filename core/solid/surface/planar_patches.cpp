#include "core/solid/surface/planar_patches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/geometry/indexed_surface.hpp"

namespace symcell::solid {
namespace {

// Deviation from its plane that a patch may have, as a share of its radius: fine tessellations of
// curved parts deviate by radius / (2 * curvature radius), which is far more.
constexpr double kFlatShare = 1e-4;
// A triangle joins a patch if their normals differ by less than 8 degrees.
constexpr double kNormalCosine = 0.99;
// Triangles thinner than this many tolerances have no normal worth asking.
constexpr double kThinTolerances = 20;
constexpr int kMostGrowths = 8;  // fits of a plane, at most: one that adds nothing is the last
// Planes closer to parallel than this (sine) have no well-defined common line.
constexpr double kParallelSine = 0.02;
// What is left of a vertex's distance from its planes, of the surface's extent: rounding.
constexpr double kRoundingRel = 1e-13;
// A vertex moves at most this many tolerances to reach all its planes.
constexpr double kMostMoves = 8;
constexpr std::size_t kCheckEvery = 1024;  // triangles: most are in a patch already

class PatchFinder {
 public:
  PatchFinder(QuotientSurface& surface,
              const FlatnessTolerances& tolerances,
              ExecutionContext& context)
      : s_(surface), tolerances_(tolerances), context_(context), rotations_(surface.fold) {}

  Result<void> run() {
    auto neighbours = find_neighbours(s_);
    if (!neighbours) return error_of(neighbours);
    neighbours_ = std::move(*neighbours);
    const std::size_t count = s_.triangles.size();
    s_.planes.clear();
    s_.patch.assign(count, -1);
    s_.frame.assign(count, 0);
    corners_.resize(count);
    std::vector<double> area(count);
    std::vector<std::int32_t> order(count);
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t t = 0; t < count; ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        corners_[t][i] = corner_point(s_, rotations_, s_.triangles[t][i]);
      }
      area[t] = length(area_normal(corners_[t][0], corners_[t][1], corners_[t][2])) / 2;
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::int32_t a, std::int32_t b) { return area[a] > area[b]; });
    visited_.assign(count, -1);
    for (std::size_t i = 0; i < count; ++i) {
      if (i % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      if (s_.patch[order[i]] < 0) grow(order[i]);
    }
    move_vertices();
    drop_bent_triangles(s_);
    return {};
  }

 private:
  struct Member {
    std::int32_t triangle;
    std::int32_t frame;
  };

  void grow(std::int32_t seed) {
    Plane plane;
    if (!plane_of(seed, plane)) return;
    std::vector<Member> members;
    double tolerance = tolerances_.noise;
    for (int round = 0; round < kMostGrowths; ++round) {
      std::vector<Member> grown = reach(seed, plane, tolerance);
      if (grown.size() <= members.size()) break;
      members = std::move(grown);
      if (members.size() < 2) return;
      const double radius = fit(members, plane);
      tolerance = std::max(tolerances_.noise, std::min(tolerances_.most, kFlatShare * radius));
    }
    // The fit may have left some corners outside.
    std::vector<Member> kept;
    for (const Member& m : members) {
      if (within(m, plane, tolerance)) kept.push_back(m);
    }
    if (kept.size() < 2) return;
    const auto id = static_cast<std::int32_t>(s_.planes.size());
    s_.planes.push_back(plane);
    for (const Member& m : kept) {
      s_.patch[m.triangle] = id;
      s_.frame[m.triangle] = is_normal_to_axis(plane) ? 0 : rotations_.reduce(m.frame);
    }
  }

  [[nodiscard]] static bool is_normal_to_axis(const Plane& plane) {
    return plane.normal.x == 0 && plane.normal.y == 0;
  }

  // Exactly normal to the axis if the corners allow it.
  [[nodiscard]] bool plane_of(std::int32_t t, Plane& plane) const {
    const auto& c = corners_[t];
    const Point3 n = area_normal(c[0], c[1], c[2]);
    const double l = length(n);
    if (!(l > 0)) return false;
    plane.normal = (1 / l) * n;
    plane.offset = dot(plane.normal, (1.0 / 3) * (c[0] + c[1] + c[2]));
    const auto [low, high] = std::minmax({c[0].z, c[1].z, c[2].z});
    if (s_.fold > 1 && std::abs(plane.normal.z) > kNormalCosine &&
        high - low <= tolerances_.noise) {
      plane.normal = {0, 0, plane.normal.z > 0 ? 1.0 : -1.0};
      plane.offset = plane.normal.z * (low + high) / 2;
    }
    return true;
  }

  [[nodiscard]] bool within(const Member& m, const Plane& plane, double tolerance) const {
    const Plane here = rotated(plane, rotations_, m.frame);
    const auto& c = corners_[m.triangle];
    for (const Point3& p : c) {
      if (std::abs(here.height(p)) > tolerance) return false;
    }
    const Point3 n = area_normal(c[0], c[1], c[2]);
    const double l = length(n);
    const double longest =
        std::sqrt(std::max({squared_distance(c[0], c[1]), squared_distance(c[1], c[2]),
                            squared_distance(c[2], c[0])}));
    const double needed = l < kThinTolerances * tolerance * longest ? 0 : kNormalCosine;
    return dot(n, here.normal) >= needed * l;
  }

  [[nodiscard]] std::vector<Member> reach(std::int32_t seed, const Plane& plane, double tolerance) {
    ++stamp_;
    std::vector<Member> members{{seed, 0}};
    visited_[seed] = stamp_;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const Member m = members[k];
      for (const QuotientNeighbour& n : neighbours_[m.triangle]) {
        if (visited_[n.triangle] == stamp_ || s_.patch[n.triangle] >= 0) continue;
        const Member next{n.triangle, m.frame - n.exponent};
        if (!within(next, plane, tolerance)) continue;
        visited_[n.triangle] = stamp_;
        members.push_back(next);
      }
    }
    return members;
  }

  // Least squares over the corners, weighted by area; a normal along the axis stays so. Returns the
  // radius of the patch.
  double fit(const std::vector<Member>& members, Plane& plane) const {
    double weight = 0;
    Point3 centre;
    const auto unrotated = [&](const Member& m, std::size_t i) {
      return rotations_.rotate(corners_[m.triangle][i], rotations_.reduce(-m.frame));
    };
    for (const Member& m : members) {
      const auto& c = corners_[m.triangle];
      const double w = length(area_normal(c[0], c[1], c[2]));
      weight += w;
      for (std::size_t i = 0; i < 3; ++i) centre = centre + (w / 3) * unrotated(m, i);
    }
    centre = (1 / weight) * centre;
    const double radius = std::sqrt(weight / 2 / std::numbers::pi);
    if (is_normal_to_axis(plane)) {
      plane.offset = plane.normal.z * centre.z;
      return radius;
    }
    // Heights over the present plane as a linear function: normal equations of two slopes.
    const AxisBase base(plane.normal);
    double uu = 0, uv = 0, vv = 0, uh = 0, vh = 0;
    for (const Member& m : members) {
      const auto& c = corners_[m.triangle];
      const double w = length(area_normal(c[0], c[1], c[2]));
      for (std::size_t i = 0; i < 3; ++i) {
        const Point3 d = unrotated(m, i) - centre;
        const double u = dot(base.u, d), v = dot(base.v, d), h = dot(plane.normal, d);
        uu += w * u * u;
        uv += w * u * v;
        vv += w * v * v;
        uh += w * u * h;
        vh += w * v * h;
      }
    }
    const double determinant = uu * vv - uv * uv;
    // Too narrow for its slope to be known: keep the normal.
    if (determinant > 1e-9 * (uu + vv) * (uu + vv)) {
      const double slope_u = (uh * vv - vh * uv) / determinant;
      const double slope_v = (vh * uu - uh * uv) / determinant;
      const Point3 n = plane.normal - slope_u * base.u - slope_v * base.v;
      plane.normal = (1 / length(n)) * n;
    }
    plane.offset = dot(plane.normal, centre);
    return radius;
  }

  struct AxisBase {
    Point3 u, v;
    explicit AxisBase(Point3 n) {
      const Point3 seed = std::abs(n.x) < 0.6 ? Point3{1, 0, 0} : Point3{0, 1, 0};
      const Point3 w = cross(n, seed);
      u = (1 / length(w)) * w;
      v = cross(n, u);
    }
  };

  struct Constraint {
    std::int32_t vertex;
    std::int32_t patch;
    std::int32_t frame;  // of the plane relative to the vertex at exponent 0
    std::int32_t triangle;
  };

  void move_vertices() {
    std::vector<double> patch_area(s_.planes.size(), 0);
    std::vector<Constraint> constraints;
    for (std::size_t t = 0; t < s_.triangles.size(); ++t) {
      if (s_.patch[t] < 0) continue;
      const auto& c = corners_[t];
      patch_area[s_.patch[t]] += length(area_normal(c[0], c[1], c[2]));
      for (const OrbitVertex& v : s_.triangles[t]) {
        const bool flat = is_normal_to_axis(s_.planes[s_.patch[t]]);
        const std::int32_t frame = flat ? 0 : rotations_.reduce(s_.frame[t] - v.exponent);
        constraints.push_back({v.orbit, s_.patch[t], frame, static_cast<std::int32_t>(t)});
      }
    }
    std::sort(constraints.begin(), constraints.end(),
              [&](const Constraint& a, const Constraint& b) {
                if (a.vertex != b.vertex) return a.vertex < b.vertex;
                if (a.patch != b.patch) {
                  const double area_a = patch_area[a.patch], area_b = patch_area[b.patch];
                  return area_a != area_b ? area_a > area_b : a.patch < b.patch;
                }
                return a.frame != b.frame ? a.frame < b.frame : a.triangle < b.triangle;
              });
    double extent = 0;
    for (const Point3& p : s_.points) extent = std::max(extent, length(p));
    for (std::size_t begin = 0; begin < constraints.size();) {
      std::size_t end = begin;
      while (end < constraints.size() && constraints[end].vertex == constraints[begin].vertex)
        ++end;
      move_vertex({constraints.data() + begin, end - begin}, kRoundingRel * extent);
      begin = end;
    }
  }

  // Planes one after another, each solved along what its normal adds to those before.
  void move_vertex(std::span<const Constraint> constraints, double rounding) {
    const std::int32_t v = constraints.front().vertex;
    const Point3 start = s_.points[v];
    Point3 p = start;
    std::vector<Point3> base;  // orthonormal
    if (s_.on_axis[v] != 0) {
      base = {{1, 0, 0}, {0, 1, 0}};
    } else if (s_.on_cut[v] != 0) {
      base = {{-std::sin(s_.start_angle), std::cos(s_.start_angle), 0}};
    }
    for (std::size_t i = 0; i < constraints.size();) {
      std::size_t end = i;
      while (end < constraints.size() && constraints[end].patch == constraints[i].patch &&
             constraints[end].frame == constraints[i].frame) {
        ++end;
      }
      const Plane plane =
          rotated(s_.planes[constraints[i].patch], rotations_, constraints[i].frame);
      Point3 fresh = plane.normal;
      for (const Point3& b : base) fresh = fresh - dot(fresh, b) * b;
      const double sine = length(fresh);
      const double height = plane.height(p);
      bool kept = std::abs(height) <= rounding;
      if (!kept && sine > kParallelSine && base.size() < 3) {
        const Point3 moved = p - (height / (sine * sine)) * fresh;
        if (distance(moved, start) <= kMostMoves * tolerances_.most) {
          p = moved;
          kept = true;
        }
      }
      if (kept && sine > kParallelSine && base.size() < 3) base.push_back((1 / sine) * fresh);
      for (std::size_t k = i; !kept && k < end; ++k) s_.patch[constraints[k].triangle] = -1;
      i = end;
    }
    if (s_.on_axis[v] != 0) {
      p.x = p.y = 0;
    } else if (s_.on_cut[v] != 0) {
      const double c = std::cos(s_.start_angle), s = std::sin(s_.start_angle);
      const double r = c * p.x + s * p.y;
      p = {c * r, s * r, p.z};
    }
    s_.points[v] = p;
  }

  QuotientSurface& s_;
  const FlatnessTolerances& tolerances_;
  ExecutionContext& context_;
  RotationTable rotations_;
  std::vector<std::array<QuotientNeighbour, 3>> neighbours_;
  std::vector<std::array<Point3, 3>> corners_;
  std::vector<std::int32_t> visited_;
  std::int32_t stamp_ = 0;
};

}  // namespace

Result<void> flatten_planar_patches(QuotientSurface& surface,
                                    const FlatnessTolerances& tolerances,
                                    ExecutionContext& context) {
  return PatchFinder(surface, tolerances, context).run();
}

void drop_bent_triangles(QuotientSurface& surface) {
  const RotationTable rotations(surface.fold);
  double extent = 0;
  for (const Point3& p : surface.points) extent = std::max(extent, length(p));
  // A few roundings of coordinates, of the plane's numbers and of the rotation.
  const double rounding = 1e-11 * extent;
  std::vector<std::int32_t> members(surface.planes.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::int32_t& patch = surface.patch[t];
    if (patch < 0) continue;
    const Plane plane = rotated(surface.planes[patch], rotations, surface.frame[t]);
    std::array<Point3, 3> c;
    bool flat = true;
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = corner_point(surface, rotations, surface.triangles[t][i]);
      flat = flat && std::abs(plane.height(c[i])) <= rounding;
    }
    // Turned over by the moves: left to the checks, in no plane.
    flat = flat && dot(area_normal(c[0], c[1], c[2]), plane.normal) > 0;
    if (flat) {
      ++members[patch];
    } else {
      patch = -1;
    }
  }
  for (std::int32_t& patch : surface.patch) {
    if (patch >= 0 && members[patch] < 2) patch = -1;
  }
}

}  // namespace symcell::solid
