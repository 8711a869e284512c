#include "core/plane/arcs/find_chords.hpp"

#include <algorithm>
#include <tuple>

#include "core/geometry/point_grid.hpp"
#include "core/geometry/resolution.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::plane {
namespace {

struct Chord {
  std::int32_t low = 0;  // vertices, ascending
  std::int32_t high = 0;
  double bulge = 0;  // from low to high
};

Chord chord(std::int32_t a, std::int32_t b, double bulge) {
  return a < b ? Chord{a, b, bulge} : Chord{b, a, -bulge};
}

}  // namespace

void find_chords(const Pslg& chorded, double tolerance, SymmetricPslg& symmetric) {
  std::vector<Chord> chords;
  const double radius = std::max(2 * tolerance, resolution_of(chorded.vertices));
  PointGrid ends(radius, chorded.vertices.size());
  for (std::size_t v = 0; v < chorded.vertices.size(); ++v) {
    ends.insert(chorded.vertices[v] - symmetric.centre, static_cast<std::int32_t>(v));
  }
  for (std::size_t s = 0; s < chorded.segments.size(); ++s) {
    if (chorded.bulge(s) == 0) continue;
    chords.push_back(chord(chorded.segments[s].a, chorded.segments[s].b, chorded.bulge(s)));
  }
  const auto by_ends = [](const Chord& x, const Chord& y) {
    return std::tie(x.low, x.high) < std::tie(y.low, y.high);
  };
  std::sort(chords.begin(), chords.end(), by_ends);

  const RotationTable rotations(symmetric.fold);
  const auto vertex_at = [&](OrbitVertex v) {
    const Point2 p = symmetric.orbit_points[static_cast<std::size_t>(v.orbit)];
    return ends.nearest(v.orbit == symmetric.centre_orbit ? p : rotations.rotate(p, v.exponent));
  };
  symmetric.bulges.assign(symmetric.segments.size(), 0);
  for (std::size_t s = 0; s < symmetric.segments.size(); ++s) {
    const std::int32_t a = vertex_at(symmetric.segments[s].a);
    const std::int32_t b = vertex_at(symmetric.segments[s].b);
    if (a < 0 || b < 0) continue;
    const Chord wanted = chord(a, b, 1);
    const auto found = std::lower_bound(chords.begin(), chords.end(), wanted, by_ends);
    if (found == chords.end() || by_ends(wanted, *found)) continue;
    symmetric.bulges[s] = wanted.bulge * found->bulge;
  }
}

}  // namespace symcell::plane
