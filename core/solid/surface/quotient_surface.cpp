#include "core/solid/surface/quotient_surface.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace symcell::solid {

std::vector<QuotientEdgeUse> sorted_edge_uses(const QuotientSurface& surface) {
  std::vector<QuotientEdgeUse> uses;
  uses.reserve(3 * surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (std::int32_t side = 0; side < 3; ++side) {
      OrbitVertex a = surface.triangles[t][side], b = surface.triangles[t][(side + 1) % 3];
      QuotientEdgeUse use;
      use.triangle = static_cast<std::int32_t>(t);
      use.side = side;
      // Of two copies of one orbit the reference is the one from which it is the shorter way.
      const bool ends_swapped =
          a.orbit != b.orbit
              ? a.orbit > b.orbit
              : 2 * ((b.exponent - a.exponent + surface.fold) % surface.fold) > surface.fold;
      use.forward = !ends_swapped;
      if (ends_swapped) std::swap(a, b);
      use.low = a.orbit;
      use.high = b.orbit;
      if (surface.on_axis[a.orbit] != 0) {
        use.frame = b.exponent;
      } else {
        use.frame = a.exponent;
        if (surface.on_axis[b.orbit] == 0) {
          use.exponent = (b.exponent - a.exponent + surface.fold) % surface.fold;
        }
      }
      uses.push_back(use);
    }
  }
  std::sort(uses.begin(), uses.end(), [](const QuotientEdgeUse& x, const QuotientEdgeUse& y) {
    return std::tie(x.low, x.high, x.exponent, x.triangle, x.side) <
           std::tie(y.low, y.high, y.exponent, y.triangle, y.side);
  });
  return uses;
}

Result<std::vector<std::array<QuotientNeighbour, 3>>> find_neighbours(
    const QuotientSurface& surface) {
  std::vector<std::array<QuotientNeighbour, 3>> result(surface.triangles.size());
  const std::vector<QuotientEdgeUse> uses = sorted_edge_uses(surface);
  for (std::size_t i = 0; i < uses.size(); i += 2) {
    const bool pair = i + 1 < uses.size() && same_edge(uses[i], uses[i + 1]) &&
                      uses[i].forward != uses[i + 1].forward &&
                      (i + 2 >= uses.size() || !same_edge(uses[i], uses[i + 2]));
    if (!pair) return fail(ErrorCode::kInternal, "the glued surface is not closed");
    const QuotientEdgeUse &a = uses[i], &b = uses[i + 1];
    result[a.triangle][a.side] = {b.triangle, b.side, a.frame - b.frame};
    result[b.triangle][b.side] = {a.triangle, a.side, b.frame - a.frame};
  }
  return result;
}

Plane rotated(const Plane& plane, const RotationTable& rotations, std::int32_t exponent) {
  return {rotations.rotate(plane.normal, rotations.reduce(exponent)), plane.offset};
}

double full_volume(const QuotientSurface& surface) {
  const RotationTable rotations(surface.fold);
  double sixfold = 0;
  for (const QuotientTriangle& t : surface.triangles) {
    const Point3 a = corner_point(surface, rotations, t[0]);
    const Point3 b = corner_point(surface, rotations, t[1]);
    const Point3 c = corner_point(surface, rotations, t[2]);
    sixfold += dot(a, cross(b, c));
  }
  return surface.fold * sixfold / 6;
}

}  // namespace symcell::solid
