#include "core/solid/surface/make_whole.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/index.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/geometry/rotation.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/model/describe.hpp"
#include "core/model/mesh_options.hpp"

namespace symcell::solid {
namespace {

// Faces that touch look against each other: their normals differ from opposite by 60 degrees at most,
// so that a wall which meets the cut is no part of it.
constexpr double kOpposite = -0.5;
// By which the areas of both cuts may differ, beside what the tolerance gives: chords of one cut and of
// the other.
constexpr double kAreaRel = 1e-3;

class Whole {
 public:
  Whole(const IndexedSurface& sector, std::int32_t sectors, const AxisFrame& axis, double tolerance)
      : triangles_(sector.triangles), axis_(axis), rotations_(sectors), tolerance_(tolerance) {
    points_.reserve(sector.points.size());
    for (const Point3& p : sector.points) points_.push_back(axis.to_local(p));
  }

  Result<TriangleSurface> run() {
    SYMCELL_TRY(find_cuts());
    join_rims();
    return copies();
  }

 private:
  // Of half a model each cut is the other's image under either turn: both are kLower.
  enum class Part : std::uint8_t { kOwn, kLower, kHigher };

  // Whether a triangle, turned by `turn` sectors, lies on the surface and looks against it.
  [[nodiscard]] bool touches(const TriangleTree& tree, const Triangle& t, std::int32_t turn) const {
    std::array<Point3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = rotations_.rotate(points_[at(t[i])], turn);
    for (std::size_t i = 0; i < 3; ++i) {
      if (!tree.within(p[i], tolerance_)) return false;
      if (!tree.within(0.5 * (p[i] + p[(i + 1) % 3]), tolerance_)) return false;
    }
    const TriangleTree::Hit hit = tree.nearest((1.0 / 3.0) * (p[0] + p[1] + p[2]), tolerance_);
    if (hit.triangle < 0) return false;
    const Triangle& u = triangles_[at(hit.triangle)];
    const Point3 n = area_normal(p[0], p[1], p[2]);
    const Point3 m = area_normal(points_[at(u[0])], points_[at(u[1])], points_[at(u[2])]);
    return dot(n, m) < kOpposite * length(n) * length(m);
  }

  Result<void> find_cuts() {
    const TriangleTree tree(points_, triangles_);
    const std::int32_t fold = rotations_.fold();
    double lower = 0, higher = 0;
    part_.assign(triangles_.size(), Part::kOwn);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const Triangle& t = triangles_[i];
      const double area =
          0.5 * length(area_normal(points_[at(t[0])], points_[at(t[1])], points_[at(t[2])]));
      if (touches(tree, t, 1)) {
        part_[i] = Part::kLower;
        lower += area;
      } else if (touches(tree, t, fold - 1)) {
        part_[i] = Part::kHigher;
        higher += area;
      }
    }
    if (fold == 2) higher = lower;
    const std::string turn = describe_rounded(360.0 / fold) + " degrees about the axis";
    if (lower == 0 || higher == 0) {
      return fail(ErrorCode::kNotSymmetric,
                  "sector: turned by " + turn +
                      " no face of the model meets another; correct sector, axis_origin and "
                      "axis_direction, or the model",
                  {}, "/options/sector");
    }
    const double slack = kAreaRel * std::max(lower, higher) + rim_length() * tolerance_;
    if (std::abs(lower - higher) <= slack) return {};
    return fail(ErrorCode::kNotSymmetric,
                "sector: the faces on which neighbours would touch differ: areas " +
                    describe_rounded(lower) + " and " + describe_rounded(higher) +
                    "; correct the model, or raise symmetry_tolerance",
                {}, "/options/sector");
  }

  // Of the edges between the cuts and the rest.
  [[nodiscard]] double rim_length() const {
    double sum = 0;
    const std::vector<EdgeUse> uses = sorted_edge_uses(triangles_);
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      if (end - begin != 2 ||
          part_[at(uses[begin].triangle)] == part_[at(uses[begin + 1].triangle)]) {
        return;
      }
      sum += distance(points_[at(uses[begin].low)], points_[at(uses[begin].high)]);
    });
    return sum;
  }

  // Corners of what stays that are corners of a cut as well.
  [[nodiscard]] std::vector<std::int32_t> rim(Part part) const {
    std::vector<std::uint8_t> seen(points_.size(), 0);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const std::uint8_t bit = part_[i] == part ? 1 : part_[i] == Part::kOwn ? 2 : 0;
      for (const std::int32_t v : triangles_[i]) seen[at(v)] |= bit;
    }
    std::vector<std::int32_t> result;
    for (std::size_t v = 0; v < seen.size(); ++v) {
      if (seen[v] == 3) result.push_back(static_cast<std::int32_t>(v));
    }
    return result;
  }

  // partner_[v]: the corner of the next copy's lower rim that v, on the higher rim, is.
  void join_rims() {
    partner_.assign(points_.size(), -1);
    const bool half = rotations_.fold() == 2;
    const std::vector<std::int32_t> lower = rim(Part::kLower);
    const std::vector<std::int32_t> higher = half ? lower : rim(Part::kHigher);
    std::vector<Point3> places;
    for (const std::int32_t v : lower) {
      Point3& p = points_[at(v)];
      if (std::hypot(p.x, p.y) <= tolerance_) p.x = p.y = 0;  // its copies meet on the axis
      places.push_back(rotations_.rotate(p, 1));
    }
    const PointTree tree(places);
    for (const std::int32_t v : higher) {
      const PointTree::Hit hit = tree.nearest(points_[at(v)]);
      if (hit.point < 0 || hit.distance > tolerance_) continue;
      const std::int32_t opposite = lower[at(hit.point)];
      if (!half || opposite < v) partner_[at(v)] = opposite;
    }
  }

  // The copy's corner that stands for v: its own, or the next copy's.
  [[nodiscard]] std::int64_t corner(std::int32_t v, std::int32_t copy) const {
    const auto count = static_cast<std::int64_t>(points_.size());
    // From a rim to the next: where both rims have one corner, as on the axis, not without end.
    if (partner_[at(v)] >= 0 && partner_[at(v)] != v) {
      return rotations_.add(copy, 1) * count + partner_[at(v)];
    }
    const bool on_axis = points_[at(v)].x == 0 && points_[at(v)].y == 0;
    return (on_axis ? 0 : copy) * count + v;
  }

  Result<TriangleSurface> copies() const {
    const auto fold = static_cast<std::size_t>(rotations_.fold());
    const auto own = static_cast<std::size_t>(std::count(part_.begin(), part_.end(), Part::kOwn));
    if (own > kMaxSurfaceTriangles / fold || points_.size() > kMaxSurfaceTriangles / fold) {
      return fail(ErrorCode::kTooLarge, "all sectors together have more triangles than " +
                                            std::to_string(kMaxSurfaceTriangles));
    }
    TriangleSurface whole;
    for (std::int32_t k = 0; k < rotations_.fold(); ++k) {
      for (const Point3& p : points_) {
        whole.vertices.push_back(axis_.to_model(rotations_.rotate(p, k)));
      }
      for (std::size_t i = 0; i < triangles_.size(); ++i) {
        if (part_[i] != Part::kOwn) continue;
        std::array<std::int32_t, 3> t{};
        for (std::size_t j = 0; j < 3; ++j) {
          t[j] = static_cast<std::int32_t>(corner(triangles_[i][j], k));
        }
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        whole.triangles.push_back(t);
        whole.source_face.push_back(static_cast<std::int32_t>(i));
      }
    }
    return whole;
  }

  std::vector<Point3> points_;  // in the frame of the axis
  const std::vector<Triangle>& triangles_;
  const AxisFrame& axis_;
  RotationTable rotations_;
  double tolerance_;
  std::vector<Part> part_;  // per triangle
  std::vector<std::int32_t> partner_;
};

}  // namespace

Result<TriangleSurface> make_whole(const IndexedSurface& sector,
                                   std::int32_t sectors,
                                   const AxisFrame& axis,
                                   double tolerance) {
  if (sectors < 2) {
    return fail(ErrorCode::kBadFold, "sector must be 2 or more", {}, "/options/sector");
  }
  return Whole(sector, sectors, axis, tolerance).run();
}

}  // namespace symcell::solid
