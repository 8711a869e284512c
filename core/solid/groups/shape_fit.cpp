#include "core/solid/groups/shape_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/base/index.hpp"
#include "core/geometry/axis_frame.hpp"
#include "core/geometry/symmetric_eigen.hpp"
#include "core/geometry/tolerances.hpp"
#include "core/solid/groups/face_regions.hpp"

namespace symcell::solid {
namespace {

// Vertices may be off the surface by so many times the noise of coordinates, or so much of its radius
// (of a plane: of the face's extent): exports with five digits are.
constexpr double kNoises = 4;
constexpr double kOffRel = 1e-3;
// Triangles of a plane look one way, those of a cylinder across its axis, to so many radians.
constexpr double kSameDirection = 1 * kRadiansADegree;
// A triangle over an arc of 60 degrees looks 30 degrees aside of the surface at its ends.
constexpr double kNormalsAgree = 31 * kRadiansADegree;
// Through three points there always is a circle.
constexpr std::size_t kLeastLines = 5;
// Through four points there always is a sphere, and a bent plate has six corners.
constexpr std::size_t kLeastOfSphere = 12;
// A gap of less than that between vertices is a side of a coarse tessellation.
constexpr double kWideGap = 100 * kRadiansADegree;
// A radius of more than so many extents of the face is not told from a plane, or from noise.
constexpr double kMostExtents = 50;
// The arc of a torus's tube stands out over its chord by so many tolerances.
constexpr double kBendOfTorus = 10;
// A cone with an angle below is a cylinder, and above its complement a plane.
constexpr double kLeastConeAngle = 0.5 * kRadiansADegree;

// Least squares: rows are added, then the normal equations solved with pivoting.
template <std::size_t N>
class LeastSquares {
 public:
  void add(const std::array<double, N>& row, double value) {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) m_[i][j] += row[i] * row[j];
      m_[i][N] += row[i] * value;
    }
  }
  // Nothing where the rows do not determine it.
  [[nodiscard]] std::optional<std::array<double, N>> solve() {
    constexpr double kSingular = 1e-13;  // of the largest entry
    double largest = 0;
    for (std::size_t i = 0; i < N; ++i) largest = std::max(largest, std::abs(m_[i][i]));
    for (std::size_t c = 0; c < N; ++c) {
      std::size_t pivot = c;
      for (std::size_t r = c + 1; r < N; ++r) {
        if (std::abs(m_[r][c]) > std::abs(m_[pivot][c])) pivot = r;
      }
      if (!(std::abs(m_[pivot][c]) > kSingular * largest)) return std::nullopt;
      std::swap(m_[c], m_[pivot]);
      for (std::size_t r = c + 1; r < N; ++r) {
        const double f = m_[r][c] / m_[c][c];
        for (std::size_t k = c; k <= N; ++k) m_[r][k] -= f * m_[c][k];
      }
    }
    std::array<double, N> x{};
    for (std::size_t i = N; i-- > 0;) {
      double sum = m_[i][N];
      for (std::size_t j = i + 1; j < N; ++j) sum -= m_[i][j] * x[j];
      x[i] = sum / m_[i][i];
    }
    return x;
  }

 private:
  std::array<std::array<double, N + 1>, N> m_{};
};

struct Sample {
  Point3 middle;  // of a triangle
  Point3 normal;  // of length 1
  double area;
};

class Fitter {
 public:
  Fitter(const IndexedSurface& surface, const std::vector<std::int32_t>& triangles, double noise)
      : noise_(noise) {
    std::vector<std::int32_t> ids;
    for (const std::int32_t t : triangles) {
      const Triangle& c = surface.triangles[at(t)];
      const Point3 n = area_normal(surface, c);
      const double twice = length(n);
      for (const std::int32_t v : c) ids.push_back(v);
      if (!(twice > 0)) continue;
      const Point3 middle = (1.0 / 3) * (surface.points[at(c[0])] + surface.points[at(c[1])] +
                                         surface.points[at(c[2])]);
      area_ += twice / 2;
      centroid_ = centroid_ + (twice / 2) * middle;
      if (is_thin(surface, c, noise)) continue;  // with a normal of chance
      samples_.push_back({middle, (1 / twice) * n, twice / 2});
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (const std::int32_t v : ids) points_.push_back(surface.points[at(v)]);
    if (area_ > 0) centroid_ = (1 / area_) * centroid_;
    if (points_.empty()) return;
    extent_ = bounding_box(points_).diagonal();
  }

  [[nodiscard]] ShapeFit run() const {
    if (samples_.empty()) return {};
    if (auto fit = plane()) return *fit;
    for (const Point3& direction : directions()) {
      if (auto fit = cylinder(direction)) return *fit;
    }
    // Two rings about one axis lie on a sphere, too: the cone is what was meant.
    for (const Point3& direction : directions()) {
      if (auto fit = cone(direction)) return *fit;
    }
    if (auto fit = sphere()) return *fit;
    if (auto fit = torus()) return *fit;
    return {};
  }

  [[nodiscard]] ShapeFit complete(const AnalyticSurface& known) const {
    ShapeFit fit;
    static_cast<AnalyticSurface&>(fit) = known;
    if (known.kind == FaceKind::kSurface) return fit;
    const bool inwards = outwards(known) < 0;
    if (known.kind == FaceKind::kPlane) {
      fit.origin = centroid_;
      if (inwards) fit.direction = -1.0 * fit.direction;
      return fit;
    }
    fit.concave = inwards;
    if (known.kind == FaceKind::kSphere) return fit;
    const std::vector<Point3> local = in_frame(AxisFrame::of_axis(known.origin, known.direction));
    double widest = 0;
    for (const Point3& p : local) widest = std::max(widest, std::hypot(p.x, p.y));
    if (known.kind == FaceKind::kCone) fit.radius = widest;
    if (widest > 0) fit.closes = round_about(local, {0, 0}, widest).widest < kWideGap;
    return fit;
  }

 private:
  [[nodiscard]] double tolerance(double size) const {
    return std::max(kNoises * noise_, kOffRel * size);
  }

  [[nodiscard]] std::optional<ShapeFit> plane() const {
    Point3 mean;
    for (const Sample& s : samples_) mean = mean + s.area * s.normal;
    if (!(length(mean) > 0)) return std::nullopt;
    mean = (1 / length(mean)) * mean;
    for (const Sample& s : samples_) {
      if (dot(s.normal, mean) < std::cos(kSameDirection)) return std::nullopt;
    }
    for (const Point3& p : points_) {
      if (std::abs(dot(p - centroid_, mean)) > tolerance(extent_)) return std::nullopt;
    }
    ShapeFit fit;
    fit.kind = FaceKind::kPlane;
    fit.origin = centroid_;
    fit.direction = mean;
    return fit;
  }

  // Directions that an axis may have: normals of cylinders are at right angles to it, those of cones at
  // one angle.
  [[nodiscard]] std::vector<Point3> directions() const {
    std::vector<Point3> found{{0, 0, 1}};
    Point3 mean;
    for (const Sample& s : samples_) mean = mean + (s.area / area_) * s.normal;
    for (const bool centred : {false, true}) {
      std::array<double, 6> m{};
      for (const Sample& s : samples_) {
        const Point3 n = centred ? s.normal - mean : s.normal;
        m[0] += s.area * n.x * n.x;
        m[1] += s.area * n.x * n.y;
        m[2] += s.area * n.x * n.z;
        m[3] += s.area * n.y * n.y;
        m[4] += s.area * n.y * n.z;
        m[5] += s.area * n.z * n.z;
      }
      found.push_back(symmetric_eigen(m).vectors[0]);
    }
    return found;
  }

  // Places that differ, along the circle: whether there are enough of them, and a gap.
  struct Round {
    std::size_t places = 0;
    double widest = 0;  // radians
  };
  [[nodiscard]] Round round_about(const std::vector<Point3>& local,
                                  Point2 centre,
                                  double radius) const {
    std::vector<double> angles;
    angles.reserve(local.size());
    for (const Point3& p : local) angles.push_back(std::atan2(p.y - centre.y, p.x - centre.x));
    std::sort(angles.begin(), angles.end());
    Round round;
    const double same = tolerance(radius) / radius;
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const double next = i + 1 < angles.size() ? angles[i + 1] : angles[0] + 2 * std::numbers::pi;
      if (next - angles[i] > same) ++round.places;
      round.widest = std::max(round.widest, next - angles[i]);
    }
    return round;
  }

  // The circle through the points' x and y, all that `use` is true of.
  struct Circle {
    Point2 centre;
    double radius = 0;
  };
  template <class Use>
  [[nodiscard]] std::optional<Circle> circle_through(const std::vector<Point3>& points,
                                                     const Use& use) const {
    LeastSquares<3> fit;
    const double scale = 1 / extent_;  // rows of one size, whatever the units
    for (const Point3& p : points) {
      if (!use(p)) continue;
      const double x = scale * p.x, y = scale * p.y;
      fit.add({x, y, 1}, x * x + y * y);
    }
    const auto x = fit.solve();
    if (!x) return std::nullopt;
    const Point2 centre{(*x)[0] / 2, (*x)[1] / 2};
    const double radius = std::sqrt((*x)[2] + squared_length(centre));
    if (!(radius >= 0)) return std::nullopt;
    return Circle{extent_ * centre, extent_ * radius};
  }

  [[nodiscard]] std::vector<Point3> in_frame(const AxisFrame& frame) const {
    std::vector<Point3> local;
    for (const Point3& p : points_) local.push_back(frame.to_local(p));
    return local;
  }

  // More than 0: the triangles look outwards of the surface, as it does at most places.
  [[nodiscard]] double outwards(const AnalyticSurface& surface) const {
    double sum = 0;
    for (const Sample& s : samples_) sum += s.area * dot(s.normal, normal_at(surface, s.middle));
    return sum;
  }

  // Whether triangles look as the surface does in their middles, all outwards or all inwards, which is told.
  [[nodiscard]] bool normals_agree(ShapeFit& fit) const {
    fit.concave = outwards(fit) < 0;
    const double sign = fit.concave ? -1 : 1;
    return std::all_of(samples_.begin(), samples_.end(), [&](const Sample& s) {
      return sign * dot(s.normal, normal_at(fit, s.middle)) >= std::cos(kNormalsAgree);
    });
  }

  [[nodiscard]] std::optional<ShapeFit> cylinder(Point3 direction) const {
    for (const Sample& s : samples_) {
      if (std::abs(dot(s.normal, direction)) > std::sin(kSameDirection)) return std::nullopt;
    }
    const AxisFrame frame = AxisFrame::of_axis(centroid_, direction);
    const std::vector<Point3> local = in_frame(frame);
    const auto circle = circle_through(local, [](Point3) { return true; });
    if (!circle) return std::nullopt;
    const auto [centre, radius] = *circle;
    if (!(radius > 0) || radius > kMostExtents * extent_) return std::nullopt;
    for (const Point3& p : local) {
      if (std::abs(distance({p.x, p.y}, centre) - radius) > tolerance(radius)) return std::nullopt;
    }
    const Round round = round_about(local, centre, radius);
    if (round.places < kLeastLines) return std::nullopt;
    ShapeFit fit;
    fit.kind = FaceKind::kCylinder;
    fit.origin = frame.to_model({centre.x, centre.y, 0});
    fit.direction = direction;
    fit.radius = radius;
    fit.closes = round.widest < kWideGap;
    if (!normals_agree(fit)) return std::nullopt;
    return fit;
  }

  [[nodiscard]] std::optional<ShapeFit> sphere() const {
    LeastSquares<4> ball;
    for (const Point3& q : points_) {
      const Point3 p = (1 / extent_) * (q - centroid_);
      ball.add({p.x, p.y, p.z, 1}, dot(p, p));
    }
    const auto x = ball.solve();
    if (!x) return std::nullopt;
    const Point3 middle{(*x)[0] / 2, (*x)[1] / 2, (*x)[2] / 2};
    const double radius = extent_ * std::sqrt((*x)[3] + dot(middle, middle));
    const Point3 centre = extent_ * middle;
    if (!(radius > 0) || radius > kMostExtents * extent_) return std::nullopt;
    ShapeFit fit;
    fit.kind = FaceKind::kSphere;
    fit.origin = centroid_ + centre;
    fit.radius = radius;
    if (points_.size() < kLeastOfSphere) return std::nullopt;
    for (const Point3& p : points_) {
      if (std::abs(distance(p, fit.origin) - radius) > tolerance(radius)) return std::nullopt;
    }
    if (!normals_agree(fit)) return std::nullopt;
    return fit;
  }

  // r = slope |z - apex| about a line along z.
  struct Slope {
    Point2 centre;
    double slope = 0;
    double apex = 0;
  };

  [[nodiscard]] std::optional<ShapeFit> cone(Point3 direction) const {
    const AxisFrame frame = AxisFrame::of_axis(centroid_, direction);
    const std::vector<Point3> local = in_frame(frame);
    for (const auto& found : {slope_of_rings(local), slope_of_all(local)}) {
      if (!found) continue;
      if (auto fit = cone_of(*found, local, frame)) return fit;
    }
    return std::nullopt;
  }

  // r^2 is a polynomial in x, y and z.
  [[nodiscard]] std::optional<Slope> slope_of_all(const std::vector<Point3>& local) const {
    LeastSquares<5> quadric;
    for (const Point3& q : local) {
      const Point3 p = (1 / extent_) * q;
      quadric.add({p.x, p.y, p.z * p.z, p.z, 1}, p.x * p.x + p.y * p.y);
    }
    const auto x = quadric.solve();
    if (!x || !((*x)[2] > 0)) return std::nullopt;
    return Slope{extent_ * Point2{(*x)[0] / 2, (*x)[1] / 2}, std::sqrt((*x)[2]),
                 -extent_ * (*x)[3] / (2 * (*x)[2])};
  }

  [[nodiscard]] std::optional<ShapeFit> cone_of(const Slope& found,
                                                const std::vector<Point3>& local,
                                                const AxisFrame& frame) const {
    const auto [centre, slope, apex_z] = found;
    const Point3 direction = frame.direction();
    const double half = std::atan(slope);
    if (half < kLeastConeAngle || half > std::numbers::pi / 2 - kLeastConeAngle)
      return std::nullopt;
    double widest = 0;
    bool above = false, below = false;
    for (const Point3& p : local) {
      const double r = distance({p.x, p.y}, centre);
      widest = std::max(widest, r);
      above = above || p.z - apex_z > tolerance(extent_);
      below = below || p.z - apex_z < -tolerance(extent_);
    }
    if (above == below || widest > kMostExtents * extent_) return std::nullopt;
    for (const Point3& p : local) {
      const double r = distance({p.x, p.y}, centre);
      const double off = (r - slope * std::abs(p.z - apex_z)) * std::cos(half);
      if (std::abs(off) > tolerance(widest)) return std::nullopt;
    }
    std::vector<Point3> off_apex;
    for (const Point3& p : local) {
      if (distance({p.x, p.y}, centre) > tolerance(widest)) off_apex.push_back(p);
    }
    const Round round = round_about(off_apex, centre, widest);
    if (round.places < kLeastLines) return std::nullopt;
    ShapeFit fit;
    fit.kind = FaceKind::kCone;
    fit.origin = frame.to_model({centre.x, centre.y, 0});
    // From the apex to the wide end.
    fit.direction = above ? direction : -1.0 * direction;
    fit.apex = frame.to_model({centre.x, centre.y, apex_z});
    fit.half_angle = half;
    fit.radius = widest;
    fit.closes = round.widest < kWideGap;
    if (!normals_agree(fit)) return std::nullopt;
    return fit;
  }

  // Of a chamfer: two rings of vertices, which leave z^2 undetermined.
  [[nodiscard]] std::optional<Slope> slope_of_rings(const std::vector<Point3>& local) const {
    double low = local[0].z, high = local[0].z;
    for (const Point3& p : local) {
      low = std::min(low, p.z);
      high = std::max(high, p.z);
    }
    const double near = tolerance(extent_);
    if (high - low <= 2 * near) return std::nullopt;
    const bool two = std::all_of(local.begin(), local.end(), [&](const Point3& p) {
      return p.z - low <= near || high - p.z <= near;
    });
    if (!two) return std::nullopt;
    const auto lower = circle_through(local, [&](Point3 p) { return p.z - low <= near; });
    const auto upper = circle_through(local, [&](Point3 p) { return high - p.z <= near; });
    if (!lower || !upper || distance(lower->centre, upper->centre) > near) return std::nullopt;
    const double slope = (upper->radius - lower->radius) / (high - low);
    if (slope == 0) return std::nullopt;
    return Slope{0.5 * (lower->centre + upper->centre), std::abs(slope),
                 low - lower->radius / slope};
  }

  // About the z axis only, which fillets and rims of a symmetric part have.
  [[nodiscard]] std::optional<ShapeFit> torus() const {
    std::vector<Point3> profile;
    for (const Point3& p : points_) profile.push_back({std::hypot(p.x, p.y), p.z - centroid_.z, 0});
    const auto circle = circle_through(profile, [](Point3) { return true; });
    if (!circle) return std::nullopt;
    const double major = circle->centre.x, z = circle->centre.y, minor = circle->radius;
    if (!(minor > 0) || !(major > tolerance(minor)) || minor > kMostExtents * extent_)
      return std::nullopt;
    for (const Point3& p : profile) {
      if (std::abs(std::hypot(p.x - major, p.y - z) - minor) > tolerance(minor))
        return std::nullopt;
    }
    // The four places of a bore with two chamfers lie on a circle, too.
    const Round tube = round_about(profile, {major, z}, minor);
    if (tube.places < kLeastLines || round_about(points_, {0, 0}, major).places < kLeastLines) {
      return std::nullopt;
    }
    // What bends by no more than vertices may be off is not told from a cylinder or a cone.
    const double half_arc = std::numbers::pi - tube.widest / 2;
    if (minor * (1 - std::cos(half_arc)) < kBendOfTorus * tolerance(minor)) return std::nullopt;
    ShapeFit fit;
    fit.kind = FaceKind::kTorus;
    fit.origin = {0, 0, centroid_.z + z};
    fit.direction = {0, 0, 1};
    fit.radius = major;
    fit.tube_radius = minor;
    if (!normals_agree(fit)) return std::nullopt;
    return fit;
  }

  double noise_;
  std::vector<Point3> points_;
  std::vector<Sample> samples_;
  double area_ = 0;
  Point3 centroid_;
  double extent_ = 0;
};

}  // namespace

ShapeFit fit_shape(const IndexedSurface& surface,
                   const std::vector<std::int32_t>& triangles,
                   double noise) {
  return Fitter(surface, triangles, noise).run();
}

ShapeFit complete_shape(const AnalyticSurface& known,
                        const IndexedSurface& surface,
                        const std::vector<std::int32_t>& triangles,
                        double noise) {
  return Fitter(surface, triangles, noise).complete(known);
}

}  // namespace symcell::solid
