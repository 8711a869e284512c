#include "core/solid/symmetry/plc_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/geometry/symmetric_eigen.hpp"

namespace symcell::solid {
namespace {

// Directions tried where the moments leave the axis open; fewer in large models, so that vertices
// times directions stay bounded.
constexpr std::size_t kMaxDirections = 3000;
constexpr std::size_t kMaxWork = 20'000'000;
// Vertices of the smallest shell whose pairs and triples are looked at.
constexpr std::size_t kMaxShell = 64;
// Moments closer than this, relatively, count as equal. Generous: more directions cost time only.
constexpr double kEqualMoments = 1e-3;

Point3 centroid_of(const std::vector<Point3>& points) {
  // Relative to the first: far from the origin the plain sum would lose digits.
  Point3 sum;
  for (const Point3 p : points) sum = sum + (p - points.front());
  return points.front() + (1 / static_cast<double>(points.size())) * sum;
}

// Points as (first, second) sorted and grouped where neighbours differ by at most `gap` in both.
template <class Visit>
void each_group(std::vector<std::array<double, 2>>& keys, double gap, Visit visit) {
  std::sort(keys.begin(), keys.end());
  for (std::size_t begin = 0; begin < keys.size();) {
    std::size_t end = begin + 1;
    while (end < keys.size() && keys[end][0] - keys[end - 1][0] <= gap) ++end;
    std::vector<double> second;
    for (std::size_t i = begin; i < end; ++i) second.push_back(keys[i][1]);
    std::sort(second.begin(), second.end());
    for (std::size_t b = 0; b < second.size();) {
      std::size_t e = b + 1;
      while (e < second.size() && second[e] - second[e - 1] <= gap) ++e;
      if (!visit(e - b, second[b], keys[begin][0])) return;
      b = e;
    }
    begin = end;
  }
}

// Greatest common divisor of the numbers of points at equal height and radius, the axis apart.
std::int64_t greatest_fold(const std::vector<Point3>& points,
                           const AxisFrame& frame,
                           double tolerance) {
  std::vector<std::array<double, 2>> keys;
  keys.reserve(points.size());
  for (const Point3 p : points) {
    const Point3 local = frame.to_local(p);
    const double radius = length(Point2{local.x, local.y});
    if (radius > 2 * tolerance) keys.push_back({local.z, radius});
  }
  std::int64_t result = 0;
  each_group(keys, 2 * tolerance, [&](std::size_t count, double, double) {
    result = std::gcd(result, static_cast<std::int64_t>(count));
    return result != 1;
  });
  return result;
}

std::array<double, 6> second_moments(const std::vector<Point3>& points, Point3 centre) {
  std::array<double, 6> m{};
  for (const Point3 p : points) {
    const Point3 d = p - centre;
    m[0] += d.x * d.x;
    m[1] += d.x * d.y;
    m[2] += d.x * d.z;
    m[3] += d.y * d.y;
    m[4] += d.y * d.z;
    m[5] += d.z * d.z;
  }
  return m;
}

struct FacetMass {
  Point3 centroid;
  double area = 0;
};

std::vector<FacetMass> facet_masses(const PlcComplex& complex) {
  std::vector<FacetMass> result;
  const auto point = [&](std::int32_t i) { return complex.points[static_cast<std::size_t>(i)]; };
  for (const ComplexFacet& facet : complex.facets) {
    FacetMass mass;
    Point3 sum;
    if (facet.triangles.triangles.empty()) continue;
    const Point3 base = point(facet.triangles.triangles.front()[0]);
    for (const auto& t : facet.triangles.triangles) {
      const Point3 a = point(t[0]) - base, b = point(t[1]) - base, c = point(t[2]) - base;
      const double area = 0.5 * length(cross(b - a, c - a));
      mass.area += area;
      sum = sum + (area / 3) * (a + b + c);
    }
    if (!(mass.area > 0)) continue;
    mass.centroid = base + (1 / mass.area) * sum;
    result.push_back(mass);
  }
  return result;
}

std::array<double, 6> facet_moments(const std::vector<FacetMass>& masses, Point3 centre) {
  std::array<double, 6> m{};
  for (const FacetMass& mass : masses) {
    const auto one = second_moments({mass.centroid}, centre);
    for (std::size_t i = 0; i < 6; ++i) m[i] += mass.area * one[i];
  }
  return m;
}

class CandidateSearch {
 public:
  CandidateSearch(const PlcComplex& complex, const std::optional<Point3>& origin, double tolerance)
      : complex_(complex),
        points_(complex.points),
        centre_(origin ? *origin : centroid_of(complex.points)),
        tolerance_(tolerance) {}

  AxisCandidates along(Point3 direction) {
    add(direction, true);
    return {std::move(result_), false, false};
  }

  AxisCandidates principal() {
    const SymmetricEigen by_vertices = symmetric_eigen(second_moments(points_, centre_));
    const SymmetricEigen by_facets =
        symmetric_eigen(facet_moments(facet_masses(complex_), centre_));
    for (const SymmetricEigen* eigen : {&by_vertices, &by_facets}) {
      for (std::size_t i = 3; i-- > 0;) add(canonical(clean(eigen->vectors[i])), true);
    }
    return {sorted(), is_open(by_vertices) && is_open(by_facets),
            is_isotropic(by_vertices) && is_isotropic(by_facets)};
  }

  std::vector<AxisCandidate> scattered() {
    find_shell();
    for (const FacetMass& mass : facet_masses(complex_)) add(mass.centroid - centre_, false);
    for (const Point3 p : points_) add(p - centre_, false);
    for (const ComplexEdge& e : complex_.edges) {
      const Point3 a = points_[static_cast<std::size_t>(e.a)] - centre_;
      add(0.5 * (a + points_[static_cast<std::size_t>(e.b)] - centre_), false);
    }
    tried_ = 0;  // the shell has a share of its own
    add_from_shell();
    return sorted();
  }

 private:
  static bool is_open(const SymmetricEigen& eigen) {
    const double gap = kEqualMoments * std::abs(eigen.values[2]);
    return eigen.values[1] - eigen.values[0] <= gap || eigen.values[2] - eigen.values[1] <= gap;
  }
  static bool is_isotropic(const SymmetricEigen& eigen) {
    return eigen.values[2] - eigen.values[0] <= kEqualMoments * std::abs(eigen.values[2]);
  }

  std::vector<AxisCandidate> sorted() {
    std::stable_sort(result_.begin(), result_.end(),
                     [](const AxisCandidate& a, const AxisCandidate& b) {
                       return a.greatest_fold > b.greatest_fold;
                     });
    return std::move(result_);
  }

  // Components that are rounding errors become zero.
  static Point3 clean(Point3 d) {
    constexpr double kRounding = 1e-12;  // of the length: some digits above roundoff
    const double size = length(d);
    const auto keep = [&](double x) { return std::abs(x) <= kRounding * size ? 0.0 : x; };
    return {keep(d.x), keep(d.y), keep(d.z)};
  }

  // One direction of each pair of opposite ones: the last large component is positive.
  static Point3 canonical(Point3 d) {
    constexpr double kLarge = 1e-6;  // of a unit vector: its sign is not one of rounding
    const double first = std::abs(d.z) > kLarge ? d.z : std::abs(d.y) > kLarge ? d.y : d.x;
    return first < 0 ? -1.0 * d : d;
  }

  // `keep`: also if it allows no fold, and however short the direction.
  void add(Point3 direction, bool keep) {
    const double size = length(direction);
    if (!(size > tolerance_) && !keep) return;
    if (!keep) {
      if (++tried_ > std::min(kMaxDirections, kMaxWork / points_.size())) return;
      direction = canonical((1 / size) * direction);
    }
    constexpr double kSame = 1e-7;  // sine of the angle between two that are one but for rounding
    for (const AxisCandidate& c : result_) {
      if (length(cross(c.frame.direction(), direction)) <= kSame) return;
    }
    const AxisFrame frame = AxisFrame::of_axis(centre_, direction);
    if (!keep && !shell_.empty() && greatest_fold(shell_, frame, 4 * tolerance_) == 1) return;
    // A guessed axis may be off by some tolerances.
    const std::int64_t fold = greatest_fold(points_, frame, 4 * tolerance_);
    if (fold != 1 || keep) result_.push_back({frame, fold});
  }

  // The vertices at that distance from the centre which the fewest share.
  void find_shell() {
    std::vector<std::array<double, 2>> keys;
    for (const Point3 p : points_) keys.push_back({0, distance(p, centre_)});
    std::size_t best = kMaxShell + 1;
    double radius = 0;
    each_group(keys, 2 * tolerance_, [&](std::size_t count, double r, double) {
      if (r > 4 * tolerance_ && count < best && count > 1) {
        best = count;
        radius = r;
      }
      return true;
    });
    if (best > kMaxShell) return;
    for (const Point3 p : points_) {
      const double r = distance(p, centre_);
      // A group begins at its smallest radius; a few tolerances hold all of it.
      if (r >= radius && r <= radius + 8 * tolerance_) shell_.push_back(p);
    }
  }

  // An axis that turns u into v and v into w is normal to both differences; one of half a turn
  // passes the middle of u and v.
  void add_from_shell() {
    for (std::size_t v = 1; v < shell_.size(); ++v) {
      add(0.5 * (shell_[0] - centre_ + shell_[v] - centre_), false);
      for (std::size_t w = 1; w < shell_.size(); ++w) {
        if (w == v) continue;
        const Point3 first = shell_[v] - shell_[0];
        const Point3 second = shell_[w] - shell_[v];
        if (std::abs(length(first) - length(second)) > 8 * tolerance_) continue;
        const Point3 normal = cross(first, second);
        constexpr double kStraight = 1e-6;  // sine below which the three lie on one line
        if (length(normal) > kStraight * length(first) * length(second)) {
          add((complex_.diameter / length(normal)) * normal, false);
        }
      }
    }
  }

  const PlcComplex& complex_;
  const std::vector<Point3>& points_;
  Point3 centre_;
  double tolerance_;
  std::size_t tried_ = 0;
  std::vector<Point3> shell_;
  std::vector<AxisCandidate> result_;
};

}  // namespace

AxisCandidates principal_axes(const PlcComplex& complex,
                              const std::optional<Point3>& origin,
                              const std::optional<Point3>& direction,
                              double tolerance) {
  CandidateSearch search(complex, origin, tolerance);
  return direction ? search.along(*direction) : search.principal();
}

std::vector<AxisCandidate> scattered_axes(const PlcComplex& complex,
                                          const std::optional<Point3>& origin,
                                          double tolerance) {
  return CandidateSearch(complex, origin, tolerance).scattered();
}

}  // namespace symcell::solid
