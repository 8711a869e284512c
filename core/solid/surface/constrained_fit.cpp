#include "core/solid/surface/constrained_fit.hpp"

#include <cmath>

namespace symcell::solid {
namespace {

// Normals closer to what is kept than this (sine) add nothing but rounding.
constexpr double kSameSine = 1e-6;
// Weight of a short displacement against the pulls.
constexpr double kDamping = 0.05;
// Coordinate descent on at most three unknowns: far more sweeps than it takes.
constexpr int kSweeps = 60;

Point3 without(Point3 v, const std::vector<Point3>& base) {
  for (const Point3& b : base) v = v - dot(v, b) * b;
  return v;
}

}  // namespace

void ConstrainedFit::keep(Point3 normal) {
  const Point3 fresh = without(normal, kept_);
  const double sine = length(fresh);
  if (sine > kSameSine && kept_.size() < 3) kept_.push_back((1 / sine) * fresh);
}

void ConstrainedFit::pull(Point3 normal, double height, double weight) {
  pulls_.push_back({normal, height, weight});
}

// Solved on free directions by Gauss-Seidel: the matrix is positive definite.
Point3 ConstrainedFit::displacement() const {
  std::vector<Point3> free;
  std::vector<Point3> base = kept_;
  for (const Point3& seed : {Point3{1, 0, 0}, Point3{0, 1, 0}, Point3{0, 0, 1}}) {
    // Of the remaining directions at least one seed is far from all of the base.
    const Point3 fresh = without(without(seed, base), base);
    if (length(fresh) < 0.5 || base.size() == 3) continue;
    free.push_back((1 / length(fresh)) * fresh);
    base.push_back(free.back());
  }
  Point3 d;
  double total = 0;
  for (const Pull& p : pulls_) total += p.weight;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const Point3& f : free) {
      double up = -kDamping * total * dot(f, d), down = kDamping * total;
      for (const Pull& p : pulls_) {
        const double slope = dot(p.normal, f);
        up += p.weight * slope * (p.height - dot(p.normal, d));
        down += p.weight * slope * slope;
      }
      if (down > 0) d = d + (up / down) * f;
    }
  }
  return without(d, kept_);
}

}  // namespace symcell::solid
