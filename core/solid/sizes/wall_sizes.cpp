#include "core/solid/sizes/wall_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/index.hpp"

namespace symcell::solid {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
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
                                           const TriangleTree& tree,
                                           double across,
                                           bool two_sided,
                                           ExecutionContext& context) {
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
    const Point3 twice = area_normal(p[0], p[1], p[2]);
    const double area = length(twice);
    if (!(area > 0)) continue;
    double thickness = kNone;
    for (const double side : {-1.0, 1.0}) {
      if (side > 0 && !two_sided) break;
      const Point3 inwards = (side / area) * twice;
      for (const auto& w : kPlaces) {
        const Point3 from = w[0] * p[0] + w[1] * p[1] + w[2] * p[2] + kBehind * extent * inwards;
        const TriangleTree::Meeting hit = tree.first_met(from, inwards);
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
